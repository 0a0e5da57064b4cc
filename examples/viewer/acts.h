/* SPDX-License-Identifier: MIT */
/* acts.h: what moves by itself, each act in its own way. Where things are depends on the time alone. */
#ifndef VIEWER_ACTS_H
#define VIEWER_ACTS_H

#include "options.h"
#include "parts.h"

#include <Imath/ImathRandom.h>

namespace viewer {

class Act {
  public:
    virtual ~Act() = default;

    /** Brings all to where it is at `time` seconds; the first call inserts what is not in the scene yet. */
    virtual void advance(double time, demo::Looks &looks) = 0;

    /** Leaves an object to others, for good, if it is one of this act's: it stays where it is. */
    virtual bool release(rg_object object) = 0;
};

/** Balls; how they move is for those to say who derive from it. */
class Balls : public Act {
  public:
    bool release(rg_object object) override;
    void advance(double time, demo::Looks &looks) override;

  protected:
    explicit Balls(demo::Stage &stage) : stage_(stage), form_(stage.sphere(1)) {}

    struct Motion {
        Imath::V3d home;
        Imath::V3d a, b; /* the directions that place() goes in */
        double phase;
    };

    void add(double radius, const Motion &motion);
    virtual Imath::V3d place(const Motion &motion, double time) const = 0;

    demo::Stage &stage_;

  private:
    const demo::Form form_; /* of all of them, each with its own scale */
    std::vector<demo::Body> bodies_;
    std::vector<Motion> motions_; /* one a body */
    bool inserted_ = false;
};

/**
 * A sphere with nine others of a third of its size on it, each of which has nine on it, and so on. They fly apart,
 * far out of the box in which they began, and come together again.
 */
class Flake : public Balls {
  public:
    /** Above `floor`, within a radius of 1. */
    Flake(demo::Stage &stage, uint32_t generations, double floor, uint64_t seed);

  private:
    void grow(const Imath::V3d &centre, double radius, const Imath::V3d &axis, const Imath::V3d &drift,
              uint32_t generations);
    Imath::V3d place(const Motion &motion, double time) const override;

    const double floor_;
    Imath::Rand48 random_;
};

/** Balls of one size in a cube, of which a share goes round in small circles and the others rest. */
class Field : public Balls {
  public:
    /** Fills the cube from -1 to 1 by a twentieth. */
    Field(demo::Stage &stage, demo::Looks &looks, uint32_t count, double share, uint64_t seed);

  private:
    Imath::V3d place(const Motion &motion, double time) const override;
};

/** A glTF model that is taken apart and put together, and plays its animations. */
class Engine : public Act {
  public:
    Engine(demo::Stage &stage, const std::string &path, uint64_t seed, const demo::Notes &notes);

    void advance(double time, demo::Looks &looks) override;
    bool release(rg_object object) override { return parts_.release(object); }
    double floor() const { return parts_.floor(); }

  private:
    const demo::Notes notes_;
    const demo::Model model_;
    demo::Parts parts_;
};

} // namespace viewer

#endif
