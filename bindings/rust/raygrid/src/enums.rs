// SPDX-License-Identifier: MIT
//! The library's enumerations.

use raygrid_sys as sys;

use crate::{Error, ErrorKind};

/// An enum whose values are the library's, and the way back from them.
macro_rules! enumeration {
    ($(#[$doc:meta])* $name:ident, $what:literal, $default:ident, {
        $($(#[$value_doc:meta])* $value:ident = $constant:ident,)*
    }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[non_exhaustive]
        #[repr(i32)]
        pub enum $name {
            $($(#[$value_doc])* $value = sys::$constant,)*
        }

        impl $name {
            /// All values.
            pub const ALL: &'static [Self] = &[$(Self::$value),*];
        }

        impl Default for $name {
            fn default() -> Self {
                Self::$default
            }
        }

        impl TryFrom<i32> for $name {
            type Error = Error;

            fn try_from(value: i32) -> Result<Self, Error> {
                Self::ALL.iter().copied().find(|&one| one as i32 == value).ok_or_else(|| {
                    Error::new(ErrorKind::InvalidArgument, format!("{} is {value}, which is none", $what))
                })
            }
        }
    };
}

enumeration! {
    /// How a grid stores its objects.
    GridKind, "kind", Default, {
        /// What suits most scenes: the loose kind.
        Default = RG_GRID_DEFAULT,
        /// One level of cells; an object is listed in every cell that it overlaps. For objects of like size.
        Uniform = RG_GRID_UNIFORM,
        /// Levels of cells, each twice as wide as the one below; an object is listed at the level that fits its size.
        Hierarchical = RG_GRID_HIERARCHICAL,
        /// A lattice of cells made where objects are; each object is stored once, in a cell that fits its size.
        Loose = RG_GRID_LOOSE,
    }
}

enumeration! {
    /// Which sides of surfaces rays hit.
    Cull, "cull", None, {
        /// Both.
        None = RG_CULL_NONE,
        /// Fronts only: where the ray runs against the normal.
        Back = RG_CULL_BACK,
        /// Backs only.
        Front = RG_CULL_FRONT,
    }
}

enumeration! {
    /// Whether rays that follow one another in a call go nearly the same way. No answer depends on it, only time.
    Coherence, "coherence", Unknown, {
        /// Looked at, 16 rays at a time.
        Unknown = RG_COHERENCE_UNKNOWN,
        /// They do not, as rays of random directions.
        Low = RG_COHERENCE_LOW,
        /// They do, as rays from a camera or to a light, in small tiles.
        High = RG_COHERENCE_HIGH,
    }
}

enumeration! {
    /// The instructions that the kernels of a scene use.
    Isa, "isa", Portable, {
        /// Plain C.
        Portable = RG_ISA_PORTABLE,
        /// SSE2, on any 64-bit x86.
        Sse2 = RG_ISA_SSE2,
        /// AVX2 and FMA.
        Avx2 = RG_ISA_AVX2,
        /// AVX-512 F, VL, DQ and BW.
        Avx512 = RG_ISA_AVX512,
        /// NEON, on 64-bit ARM.
        Neon = RG_ISA_NEON,
    }
}

enumeration! {
    /// A call that changes a scene, as recordings have them.
    Call, "call", None, {
        /// None that this version of the binding has a name for.
        None = RG_CALL_NONE,
        /// [`Scene::insert`](crate::Scene::insert).
        Insert = RG_CALL_INSERT,
        /// [`Scene::insert_many`](crate::Scene::insert_many), and by [`Insert`](crate::Insert).
        InsertMany = RG_CALL_INSERT_MANY,
        /// [`Scene::move_pose`](crate::Scene::move_pose).
        Move = RG_CALL_MOVE,
        /// [`Scene::move_to`](crate::Scene::move_to).
        MoveTo = RG_CALL_MOVE_TO,
        /// [`Scene::move_many`](crate::Scene::move_many).
        MoveMany = RG_CALL_MOVE_MANY,
        /// [`Scene::set_mask`](crate::Scene::set_mask).
        SetMask = RG_CALL_SET_MASK,
        /// [`Scene::remove`](crate::Scene::remove).
        Remove = RG_CALL_REMOVE,
        /// [`Scene::remove_many`](crate::Scene::remove_many).
        RemoveMany = RG_CALL_REMOVE_MANY,
        /// [`Scene::create_grid`](crate::Scene::create_grid).
        GridCreate = RG_CALL_GRID_CREATE,
        /// [`Scene::destroy_grid`](crate::Scene::destroy_grid).
        GridDestroy = RG_CALL_GRID_DESTROY,
        /// [`Scene::configure_grid`](crate::Scene::configure_grid).
        GridConfigure = RG_CALL_GRID_CONFIGURE,
        /// [`Scene::rebuild_grid`](crate::Scene::rebuild_grid).
        GridRebuild = RG_CALL_GRID_REBUILD,
        /// [`Scene::replace_shape`](crate::Scene::replace_shape).
        ReplaceShape = RG_CALL_REPLACE_SHAPE,
    }
}

enumeration! {
    /// What kind of geometry a shape is.
    ShapeKind, "kind", Sphere, {
        /// A sphere.
        Sphere = RG_SHAPE_SPHERE,
        /// A box.
        Box = RG_SHAPE_BOX,
        /// A capsule.
        Capsule = RG_SHAPE_CAPSULE,
        /// A triangle mesh.
        Mesh = RG_SHAPE_MESH,
        /// A [`UserShape`](crate::UserShape).
        User = RG_SHAPE_USER,
    }
}

enumeration! {
    /// How much is done for rays when a mesh is made.
    MeshQuality, "quality", Best, {
        /// What rays go through fastest.
        Best = RG_MESH_BEST,
        /// What is made fastest: for meshes of which few rays are asked before they change.
        Fast = RG_MESH_FAST,
    }
}
