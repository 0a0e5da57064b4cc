/* SPDX-License-Identifier: MIT */
/* world.h: all that is in the scene: what moves by itself, the ground, and what the user has taken or made. */
#ifndef VIEWER_WORLD_H
#define VIEWER_WORLD_H

#include "acts.h"

namespace viewer {

class World {
  public:
    /** Throws std::runtime_error that names the file if it can't be used. */
    World(const Options &options, const demo::Notes &notes);

    /** Brings what moves by itself to where it is at `time` seconds. */
    void advance(double time);

    /** Takes an object out of the play, for good: from now on only the user moves it. False for the ground. */
    bool take(rg_object object);

    /** Moves an object that was taken. */
    void move(rg_object object, const Imath::V3d &position);

    /** Removes an object that was taken. */
    void remove(rg_object object);

    /** How large what insert_ball() and insert_box() make is: the distance from the middle to the surface. */
    static constexpr double handful = 0.12;
    rg_object insert_ball(const Imath::V3d &position);
    rg_object insert_box(const Imath::V3d &position);

    /** Makes the scene's grid of another kind or resolution; 0: automatic. */
    void configure(rg_grid_kind kind, uint32_t resolution);

    rg_grid_report grid() const;
    rg_scene *scene() const { return stage_.scene(); }
    const demo::Looks &looks() const { return looks_; }

    /** Whether anything has smooth normals. */
    bool smooth() const { return smooth_; }

    /** Seconds that raygrid took for changes since the last call of this. */
    double take_seconds() { return stage_.take_seconds(); }

  private:
    rg_object insert(const demo::Form &form, const Imath::V3d &position);

    demo::Stage stage_;
    demo::Looks looks_;
    std::unique_ptr<Act> act_;
    rg_object ground_ = RG_NO_OBJECT;
    demo::Form ball_, box_;
    bool smooth_ = false;
};

} // namespace viewer

#endif
