/* SPDX-License-Identifier: MIT */
/*
 * The part of the kernels that brings rays, one a lane, into the frames of objects that are meshes; included by
 * kernels.h alone. What object.c, beam.c and triangle.c do for one ray, in the same order of the same operations. All
 * lanes go to one object, or each to its own: `s` is 0 or 1, the step from one lane's door to the next.
 */

/* rgi_object_local. Sets *passed: of the rays that pass by; they are brought near all the same. */
RGI_INLINE void to_local(const rgi_bundle *b, const rgi_mesh_doors *d, const int s, rgi_mesh_packet *m,
                         int passed[RGI_PACKET]) {
    double in[3][RGI_PACKET], far[RGI_PACKET];
    int any_far = 0;
    LANES(i) {
        double oo = 0, od = 0, reach = d->reach[i * s], dd = b->dd[i];
        for (int a = 0; a < 3; a++) {
            in[a][i] = b->origin[a][i] - d->position[a][i * s];
            oo = a ? oo + in[a][i] * in[a][i] : in[a][i] * in[a][i];
            od = a ? od + in[a][i] * b->direction[a][i] : in[a][i] * b->direction[a][i];
        }
        passed[i] = oo * dd - od * od > (reach * reach * (1 + 0x1p-8) + oo * 0x1p-40) * dd;
        far[i] = oo > (double)(RGI_NEAR * RGI_NEAR) * reach * reach;
        m->shift[i] = far[i] != 0 ? -(od / dd) : 0;
        any_far |= far[i] != 0;
    }
    for (int a = 0; a < 3 && any_far; a++) {
        LANES(i) {
            double moved = rgi_rebase(b->origin[a][i], d->position[a][i * s], m->shift[i], b->direction[a][i]);
            in[a][i] = far[i] != 0 ? moved : in[a][i];
        }
    }
    if (!d->any_turned) {
        memcpy(m->origin, in, sizeof in);
        memcpy(m->direction, b->direction, sizeof m->direction);
        return;
    }
    for (int a = 0; a < 3; a++) {
        LANES(i) {
            const double x = d->inverse[3 * a][i * s], y = d->inverse[3 * a + 1][i * s];
            const double z = d->inverse[3 * a + 2][i * s];
            const bool turned = d->turned[i * s] != 0;
            double o = x * in[0][i] + y * in[1][i] + z * in[2][i];
            double e = x * b->direction[0][i] + y * b->direction[1][i] + z * b->direction[2][i];
            m->origin[a][i] = turned ? o : in[a][i];
            m->direction[a][i] = turned ? e : b->direction[a][i];
        }
    }
}

/* rgi_beam_into_mesh. Rays that come from far away are brought near even where that shows that they pass by. */
RGI_INLINE void to_mesh(const rgi_mesh_doors *door, const int s, rgi_mesh_packet *m, int passed[RGI_PACKET]) {
    rgi_packet *p = &m->rays;
    double origin[3][RGI_PACKET], direction[3][RGI_PACKET], unit[RGI_PACKET], shift[RGI_PACKET], longest[RGI_PACKET];
    double pads[RGI_PACKET];
    int any_far = 0;
    LANES(i) {
        double x = fabs(m->direction[0][i]), y = fabs(m->direction[1][i]), z = fabs(m->direction[2][i]), square = 0;
        unit[i] = from_bits((0x7FDull - (to_bits(rgi_max(rgi_max(x, y), z)) >> 52)) << 52);
        for (int a = 0; a < 3; a++) {
            origin[a][i] = m->origin[a][i] - door->origin[a][i * s];
            direction[a][i] = m->direction[a][i] * unit[i];
            double from = origin[a][i] - door->centre[a][i * s];
            square += from * from;
        }
        shift[i] = 0;
        any_far |= square > RGI_FAR * RGI_FAR * door->radius[i * s] * door->radius[i * s];
    }
    if (any_far) {
        LANES(i) {
            double square = 0, along = 0, dd = 0, radius = door->radius[i * s];
            for (int a = 0; a < 3; a++) {
                double from = origin[a][i] - door->centre[a][i * s];
                square += from * from;
                along += from * direction[a][i];
                dd += direction[a][i] * direction[a][i];
            }
            bool far = square > RGI_FAR * RGI_FAR * radius * radius;
            along /= dd;
            passed[i] |= far & (square - along * along * dd > 2 * radius * radius + 0x1p-40 * square);
            shift[i] = far ? -along - RGI_BEFORE * radius : 0;
        }
        for (int a = 0; a < 3; a++) {
            LANES(i) {
                double moved = rgi_rebase(m->origin[a][i], door->origin[a][i * s], shift[i], direction[a][i]);
                origin[a][i] = shift[i] != 0 ? moved : origin[a][i];
            }
        }
    }
    LANES(i) {
        p->shift[i] = m->shift[i] + shift[i] * unit[i];
        p->length[i] = door->scale[i * s] / unit[i];
        pads[i] = 0;
        for (int a = 0; a < 3; a++) origin[a][i] *= door->scale[i * s];
        longest[i] = 2 * (door->extent[i * s] + fabs(origin[0][i]) + fabs(origin[1][i]) + fabs(origin[2][i]));
    }
    for (int a = 0; a < 3; a++) {
        LANES(i) {
            double o = origin[a][i], d = direction[a][i];
            double pad = 0x1p-20 * fabs(o) + 0x1p-90 * fabs(p->shift[i]) * p->length[i];
            float inverse = (d < 0 ? -1.0f : 1.0f) / (float)rgi_max(fabs(d), RGI_FLAT);
            double middle = -o * (double)inverse;
            double widening = pad * fabs((double)inverse) + (fabs(d) < RGI_FLAT ? longest[i] : 0);
            p->origin[a][i] = (float)o;
            p->direction[a][i] = (float)d;
            p->inverse[a][i] = inverse;
            p->near[a][i] = (float)(middle - widening);
            p->far[a][i] = (float)(middle + widening);
            pads[i] += 2 * pad;
        }
    }
    LANES(i) p->pad[i] = (float)pads[i];
}

/* rgi_triangle_ray_init and the filters. */
RGI_INLINE void make_ready(const rgi_mesh_doors *door, const int s, rgi_mesh_packet *m) {
    const rgi_packet *p = &m->rays;
    LANES(i) {
        rgi_triangle_line t;
        const double d[3] = {m->direction[0][i], m->direction[1][i], m->direction[2][i]};
        const float o[3] = {p->origin[0][i], p->origin[1][i], p->origin[2][i]};
        const float df[3] = {p->direction[0][i], p->direction[1][i], p->direction[2][i]};
        rgi_triangle_axes(&t, d);
        m->shear[0][i] = t.shear[0];
        m->shear[1][i] = t.shear[1];
        rgi_triangle_filter_init(&m->filters[i], &t, o, df, p->inverse[t.z][i],
                                 rgi_place_error(door->extent[i * s], door->rounding[i * s], o));
    }
}

/* rgi_beam_above, rgi_beam_below: a t in the frame, kept finite; what may have been lost on the way there. */
RGI_INLINE double frame_t(const rgi_packet *p, int i, double t, double *lost) {
    double at = (t - p->shift[i]) * p->length[i];
    *lost = 0x1p-50 * fabs(p->shift[i]) * p->length[i];
    return rgi_min(rgi_max(at, -RGI_T_MOST), RGI_T_MOST);
}

static void bound_above(rgi_mesh_packet *m) {
    rgi_packet *p = &m->rays;
    LANES(i) {
        double lost, at = frame_t(p, i, m->t_max[i], &lost);
        p->t_hi[i] = (float)(at + 0x1p-19 * fabs(at) + lost) + 4 * p->pad[i];
    }
}

static void bound_below(rgi_mesh_packet *m) {
    rgi_packet *p = &m->rays;
    LANES(i) {
        double lost, at = frame_t(p, i, m->t_min[i], &lost);
        p->t_first[i] = (float)(at - 0x1p-19 * fabs(at) - lost) - 4 * p->pad[i];
    }
}

/* Returns the bits of the lanes whose rays do not pass their object by. */
RGI_INLINE uint32_t go_in(const rgi_bundle *b, const rgi_mesh_doors *doors, const int s, rgi_mesh_packet *m) {
    int passed[RGI_PACKET];
    uint32_t in = 0;
    to_local(b, doors, s, m, passed);
    to_mesh(doors, s, m, passed);
    make_ready(doors, s, m);
    memcpy(m->t_min, b->t_min, sizeof m->t_min);
    bound_below(m);
    m->found = 0;
    LANES(i) in |= (uint32_t)!passed[i] << i;
    return in;
}

static uint32_t mesh_enter(const rgi_bundle *b, const rgi_object *object, const rgi_linear *linear,
                           rgi_mesh_packet *m) {
    rgi_mesh_doors door;
    door.any_turned = false;
    rgi_mesh_door(&door, 0, object, linear);
    LANES(i) m->mesh[i] = object->shape->of.mesh;
    return go_in(b, &door, 0, m);
}
