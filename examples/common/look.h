/* SPDX-License-Identifier: MIT */
/* look.h: how objects look. */
#ifndef DEMO_LOOK_H
#define DEMO_LOOK_H

#include "gltf_mesh.h"
#include "stage.h"

#include <Imath/ImathMatrix.h>

namespace demo {

/** How an object reflects light. */
struct Look {
    enum class Kind { Plain, Ground } kind = Kind::Plain;
    Imath::V3f colour{0.8f, 0.8f, 0.8f};
    float gloss = 0;
    const Surface *surface = nullptr; /* for smooth normals; NULL: the geometric ones do */
    Imath::M33f normals;              /* takes normals of the surface to the world, for row vectors */
};

/** The looks of a scene's objects. */
class Looks {
  public:
    void set(rg_object object, const Look &look) {
        const uint32_t slot = RG_OBJECT_SLOT(object);
        if (slot >= looks_.size()) looks_.resize(slot + size_t(1));
        looks_[slot] = look;
    }
    const Look &of(rg_object object) const { return looks_[RG_OBJECT_SLOT(object)]; }

  private:
    std::vector<Look> looks_; /* by slot */
};

/** Varnish in one of some warm colours: that of an object stays with it. */
Look look_by_id(rg_object object);

/** Inserts an infinite dark floor at a height. It has thin lines a unit apart. */
rg_object insert_ground(Stage &stage, Looks &looks, double height);

} // namespace demo

#endif
