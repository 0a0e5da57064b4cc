// SPDX-License-Identifier: MIT
// Made from include/raygrid/*.h by `cargo run -p checks`. Not to be edited.
pub const RG_VERSION_MAJOR: u32 = 0;
pub const RG_VERSION_MINOR: u32 = 1;
pub const RG_VERSION_PATCH: u32 = 0;
pub const RG_COORDINATE_MAX: f64 = 10000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000.0;
pub const RG_RADIUS_MIN: f64 = 0.0000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000001;
pub const RG_GRID_OF_SCENE: u32 = 0;
pub const RG_REBUILD_NEVER: f64 = -1.0;
pub const RG_NO_OBJECT: u64 = 0;
pub const RG_FORMAT_VERSION: u32 = 2;
pub const RG_NO_PRIMITIVE: u32 = 4294967295;
unsafe extern "C" {
    ///The version of the library that is running, as major \* 1000000 + minor \* 1000 + patch. Any thread.
    pub fn rg_version() -> u32;
}
///What became of a call. 0 is success; all others are failures.
pub type rg_result = i32;
pub const RG_OK: i32 = 0;
///A pointer is NULL that must not be, a struct's size or an enumeration value is unknown.
pub const RG_INVALID_ARGUMENT: i32 = 1;
///A number is NaN, infinite, out of its range; a pose is singular; a mesh index has no vertex.
pub const RG_INVALID_VALUE: i32 = 2;
///The id of an object or grid is stale, of another scene, or was never given out.
pub const RG_INVALID_ID: i32 = 3;
///A count is beyond what the library can address.
pub const RG_LIMIT_EXCEEDED: i32 = 4;
///The allocator returned NULL.
pub const RG_OUT_OF_MEMORY: i32 = 5;
///The system refused to start a worker thread.
pub const RG_OUT_OF_THREADS: i32 = 6;
///The call would change a scene from inside a callback of that scene, or remove what is still in use.
pub const RG_BUSY: i32 = 7;
///A callback of the host reported failure or returned NaN.
pub const RG_CALLBACK_FAILED: i32 = 8;
///A snapshot or recording is damaged, of another version, or not what the call takes.
pub const RG_INVALID_DATA: i32 = 9;
unsafe extern "C" {
    ///The name of a result code, such as "RG\_INVALID\_VALUE"; "unknown" for a number that is none. Any thread.
    pub fn rg_result_name(result: rg_result) -> *const ::core::ffi::c_char;
}
unsafe extern "C" {
    /**What was wrong with the last call of this thread that failed: a sentence that names the offending value, or ""
if none failed yet. The text belongs to the thread and holds until its next failing call. Successful calls leave
it.*/
    pub fn rg_error_message() -> *const ::core::ffi::c_char;
}
/**Where memory comes from. Both functions are called from any thread that calls into the library, and from its
workers. Leave both NULL for malloc and free.
allocate: `size` \> 0 bytes aligned to `alignment`, a power of two \<= 64; NULL if there are none.
release:  gets back what allocate returned, with the same size and alignment. Never called with NULL.*/
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_allocator {
    pub user: *mut ::core::ffi::c_void,
    pub allocate: ::core::option::Option<
        unsafe extern "C" fn(
            user: *mut ::core::ffi::c_void,
            size: usize,
            alignment: usize,
        ) -> *mut ::core::ffi::c_void,
    >,
    pub release: ::core::option::Option<
        unsafe extern "C" fn(
            user: *mut ::core::ffi::c_void,
            memory: *mut ::core::ffi::c_void,
            size: usize,
            alignment: usize,
        ),
    >,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_allocator"][::core::mem::size_of::<rg_allocator>() - 24usize];
    ["Alignment of rg_allocator"][::core::mem::align_of::<rg_allocator>() - 8usize];
    [
        "Offset of field: rg_allocator::user",
    ][::core::mem::offset_of!(rg_allocator, user) - 0usize];
    [
        "Offset of field: rg_allocator::allocate",
    ][::core::mem::offset_of!(rg_allocator, allocate) - 8usize];
    [
        "Offset of field: rg_allocator::release",
    ][::core::mem::offset_of!(rg_allocator, release) - 16usize];
};
impl Default for rg_allocator {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
/**The host's own job system: call body(context, i) once for each i in \[0, count), on any threads in any order, and
return when all calls have returned. Calls of body never fail and never wait for one another.*/
pub type rg_parallel_for = ::core::option::Option<
    unsafe extern "C" fn(
        user: *mut ::core::ffi::c_void,
        count: u64,
        body: ::core::option::Option<
            unsafe extern "C" fn(context: *mut ::core::ffi::c_void, index: u64),
        >,
        context: *mut ::core::ffi::c_void,
    ),
>;
///Receives one line of text, without a line end, when something happens that a developer may want to know.
pub type rg_log = ::core::option::Option<
    unsafe extern "C" fn(
        user: *mut ::core::ffi::c_void,
        message: *const ::core::ffi::c_char,
    ),
>;
///The type of the numbers that a view reads or writes.
pub type rg_type = i32;
pub const RG_F64: i32 = 0;
pub const RG_F32: i32 = 1;
pub const RG_U8: i32 = 2;
pub const RG_U16: i32 = 3;
pub const RG_U32: i32 = 4;
pub const RG_U64: i32 = 5;
///One number a record, read.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_input {
    pub data: *const ::core::ffi::c_void,
    pub stride: isize,
    pub type_: rg_type,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_input"][::core::mem::size_of::<rg_input>() - 24usize];
    ["Alignment of rg_input"][::core::mem::align_of::<rg_input>() - 8usize];
    [
        "Offset of field: rg_input::data",
    ][::core::mem::offset_of!(rg_input, data) - 0usize];
    [
        "Offset of field: rg_input::stride",
    ][::core::mem::offset_of!(rg_input, stride) - 8usize];
    [
        "Offset of field: rg_input::type_",
    ][::core::mem::offset_of!(rg_input, type_) - 16usize];
};
impl Default for rg_input {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
///Three numbers a record, read.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_input3 {
    pub x: *const ::core::ffi::c_void,
    pub y: *const ::core::ffi::c_void,
    pub z: *const ::core::ffi::c_void,
    pub stride: isize,
    pub type_: rg_type,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_input3"][::core::mem::size_of::<rg_input3>() - 40usize];
    ["Alignment of rg_input3"][::core::mem::align_of::<rg_input3>() - 8usize];
    ["Offset of field: rg_input3::x"][::core::mem::offset_of!(rg_input3, x) - 0usize];
    ["Offset of field: rg_input3::y"][::core::mem::offset_of!(rg_input3, y) - 8usize];
    ["Offset of field: rg_input3::z"][::core::mem::offset_of!(rg_input3, z) - 16usize];
    [
        "Offset of field: rg_input3::stride",
    ][::core::mem::offset_of!(rg_input3, stride) - 24usize];
    [
        "Offset of field: rg_input3::type_",
    ][::core::mem::offset_of!(rg_input3, type_) - 32usize];
};
impl Default for rg_input3 {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
///One number a record, written.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_output {
    pub data: *mut ::core::ffi::c_void,
    pub stride: isize,
    pub type_: rg_type,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_output"][::core::mem::size_of::<rg_output>() - 24usize];
    ["Alignment of rg_output"][::core::mem::align_of::<rg_output>() - 8usize];
    [
        "Offset of field: rg_output::data",
    ][::core::mem::offset_of!(rg_output, data) - 0usize];
    [
        "Offset of field: rg_output::stride",
    ][::core::mem::offset_of!(rg_output, stride) - 8usize];
    [
        "Offset of field: rg_output::type_",
    ][::core::mem::offset_of!(rg_output, type_) - 16usize];
};
impl Default for rg_output {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
///Three numbers a record, written.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_output3 {
    pub x: *mut ::core::ffi::c_void,
    pub y: *mut ::core::ffi::c_void,
    pub z: *mut ::core::ffi::c_void,
    pub stride: isize,
    pub type_: rg_type,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_output3"][::core::mem::size_of::<rg_output3>() - 40usize];
    ["Alignment of rg_output3"][::core::mem::align_of::<rg_output3>() - 8usize];
    ["Offset of field: rg_output3::x"][::core::mem::offset_of!(rg_output3, x) - 0usize];
    ["Offset of field: rg_output3::y"][::core::mem::offset_of!(rg_output3, y) - 8usize];
    ["Offset of field: rg_output3::z"][::core::mem::offset_of!(rg_output3, z) - 16usize];
    [
        "Offset of field: rg_output3::stride",
    ][::core::mem::offset_of!(rg_output3, stride) - 24usize];
    [
        "Offset of field: rg_output3::type_",
    ][::core::mem::offset_of!(rg_output3, type_) - 32usize];
};
impl Default for rg_output3 {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
unsafe extern "C" {
    ///A view of records that hold x, y, z one after another, the first at `xyz`, each `stride` bytes after the last.
    pub fn rg_input3_packed(
        xyz: *const ::core::ffi::c_void,
        stride: isize,
        type_: rg_type,
    ) -> rg_input3;
}
unsafe extern "C" {
    ///The same for writing.
    pub fn rg_output3_packed(
        xyz: *mut ::core::ffi::c_void,
        stride: isize,
        type_: rg_type,
    ) -> rg_output3;
}
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_shape {
    _unused: [u8; 0],
}
///How much is done for rays when a mesh is made.
pub type rg_mesh_quality = i32;
pub const RG_MESH_BEST: i32 = 0;
pub const RG_MESH_FAST: i32 = 1;
///How a shape is made. NULL in place of it means all defaults.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_shape_config {
    pub size: usize,
    ///Where the shape's memory comes from; both functions NULL: malloc. Copied.
    pub allocator: rg_allocator,
    ///Of meshes: how much time their making may take.
    pub quality: rg_mesh_quality,
    /**Threads that make a mesh together, the calling one among them: 0 or 1 for the calling thread alone, at most
1024. They end before the call does. Ignored with parallel\_for.*/
    pub workers: u32,
    ///The host's job system in place of threads. NULL: none.
    pub parallel_for: rg_parallel_for,
    pub parallel_for_user: *mut ::core::ffi::c_void,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_shape_config"][::core::mem::size_of::<rg_shape_config>() - 56usize];
    [
        "Alignment of rg_shape_config",
    ][::core::mem::align_of::<rg_shape_config>() - 8usize];
    [
        "Offset of field: rg_shape_config::size",
    ][::core::mem::offset_of!(rg_shape_config, size) - 0usize];
    [
        "Offset of field: rg_shape_config::allocator",
    ][::core::mem::offset_of!(rg_shape_config, allocator) - 8usize];
    [
        "Offset of field: rg_shape_config::quality",
    ][::core::mem::offset_of!(rg_shape_config, quality) - 32usize];
    [
        "Offset of field: rg_shape_config::workers",
    ][::core::mem::offset_of!(rg_shape_config, workers) - 36usize];
    [
        "Offset of field: rg_shape_config::parallel_for",
    ][::core::mem::offset_of!(rg_shape_config, parallel_for) - 40usize];
    [
        "Offset of field: rg_shape_config::parallel_for_user",
    ][::core::mem::offset_of!(rg_shape_config, parallel_for_user) - 48usize];
};
impl Default for rg_shape_config {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
unsafe extern "C" {
    /**Fills `config` with the defaults; `size` is sizeof(rg\_shape\_config) at the caller's.
RG\_INVALID\_ARGUMENT: config is NULL or the size unknown.*/
    pub fn rg_shape_config_default(
        config: *mut rg_shape_config,
        size: usize,
    ) -> rg_result;
}
unsafe extern "C" {
    /**A sphere around the local origin. `radius` in \[RG\_RADIUS\_MIN, RG\_COORDINATE\_MAX\]; a radius of 0 is refused.
Hits: primitive 0, u = v = 0.
Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_VALUE, RG\_OUT\_OF\_MEMORY. Cost: one allocation.*/
    pub fn rg_shape_create_sphere(
        config: *const rg_shape_config,
        radius: f64,
        shape: *mut *mut rg_shape,
    ) -> rg_result;
}
unsafe extern "C" {
    /**A box with its faces in the local axes' planes, from corner `lo` to corner `hi`, lo \<= hi on each axis. It may have
no thickness (lo == hi), and may be infinite (lo -inf, hi +inf, or both), on any axis; an infinite axis needs a
pose whose linear part is the identity. Edges and corners belong to the box. Hits: primitive 0 to 5 for the faces
-x, +x, -y, +y, -z, +z: the face by which the ray enters the box (leaves it, if that is the hit), the lowest of
those where it does so at an edge or corner; u = v = 0. Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_VALUE,
RG\_OUT\_OF\_MEMORY. Cost: one allocation.*/
    pub fn rg_shape_create_box(
        config: *const rg_shape_config,
        lo: *const f64,
        hi: *const f64,
        shape: *mut *mut rg_shape,
    ) -> rg_result;
}
unsafe extern "C" {
    /**A capsule: all points within `radius` of the segment from `a` to `b` (which may be one point).
Hits: primitive 0, u = v = 0.
Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_VALUE, RG\_OUT\_OF\_MEMORY. Cost: one allocation.*/
    pub fn rg_shape_create_capsule(
        config: *const rg_shape_config,
        a: *const f64,
        b: *const f64,
        radius: f64,
        shape: *mut *mut rg_shape,
    ) -> rg_result;
}
///The triangles of a mesh. Zero it, set the size, then what is given.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_mesh_views {
    pub size: usize,
    ///Positions of the vertices, RG\_F32 or RG\_F64.
    pub vertices: rg_input3,
    pub vertex_count: u64,
    /**The three vertex indices of each triangle, RG\_U16, RG\_U32 or RG\_U64. Not given: triangle i has the vertices
3i, 3i+1 and 3i+2, and triangle\_count must be vertex\_count / 3.*/
    pub indices: rg_input3,
    pub triangle_count: u64,
    /**NULL: the data is read while the mesh is made, what it needs of it later is copied. Else that is borrowed, read
where the views say for as long as it takes: the vertices, if not all are floats or if they are of extreme size
(see the cost of rg\_shape\_create\_mesh), and the indices, if triangles share hardly any vertices. No answer
depends on it.

What all views of the call show must then stay there, and stay as it is, until `released` is called: once, as
soon as nothing reads it any more. Where nothing is needed later that is in the call that makes the mesh,
just before it returns; else when the last reference has gone, by the thread that gave it back, as
rg\_user\_shape.destroy is called. Who has references: the host, objects (those of frames, too, until these are
brought up to date), and a recording until it ends. If the call fails, `released` is not called and nothing is
read any more. Should the data change all the same, hits of this mesh may be wrong, but no other memory is
read.*/
    pub released: ::core::option::Option<
        unsafe extern "C" fn(user: *mut ::core::ffi::c_void),
    >,
    ///Handed to `released`.
    pub user: *mut ::core::ffi::c_void,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_mesh_views"][::core::mem::size_of::<rg_mesh_views>() - 120usize];
    ["Alignment of rg_mesh_views"][::core::mem::align_of::<rg_mesh_views>() - 8usize];
    [
        "Offset of field: rg_mesh_views::size",
    ][::core::mem::offset_of!(rg_mesh_views, size) - 0usize];
    [
        "Offset of field: rg_mesh_views::vertices",
    ][::core::mem::offset_of!(rg_mesh_views, vertices) - 8usize];
    [
        "Offset of field: rg_mesh_views::vertex_count",
    ][::core::mem::offset_of!(rg_mesh_views, vertex_count) - 48usize];
    [
        "Offset of field: rg_mesh_views::indices",
    ][::core::mem::offset_of!(rg_mesh_views, indices) - 56usize];
    [
        "Offset of field: rg_mesh_views::triangle_count",
    ][::core::mem::offset_of!(rg_mesh_views, triangle_count) - 96usize];
    [
        "Offset of field: rg_mesh_views::released",
    ][::core::mem::offset_of!(rg_mesh_views, released) - 104usize];
    [
        "Offset of field: rg_mesh_views::user",
    ][::core::mem::offset_of!(rg_mesh_views, user) - 112usize];
};
impl Default for rg_mesh_views {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
unsafe extern "C" {
    /**A triangle mesh. The data is copied, unless the views lend it (rg\_mesh\_views.released). At least one triangle,
fewer than 2^31 triangles and 2^32 - 1 vertices. Triangles without area are kept, so that primitive numbers hold,
and are never hit. Hits: primitive = number of the triangle; u and v the barycentric weights of its second and
third corner. Watertight: a ray at a shared edge or vertex of a closed mesh always hits one of the triangles that
share it. Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_VALUE (a vertex that is not finite or beyond RG\_COORDINATE\_MAX,
an index without a vertex; the message names its number), RG\_LIMIT\_EXCEEDED, RG\_OUT\_OF\_MEMORY, RG\_OUT\_OF\_THREADS.
Cost: O(n log n) for n triangles; while it is made up to 350 bytes a triangle. What it holds of a triangle: some 30
bytes where triangles share vertices, 50 where they do not, 62 where these have indices; and 24 bytes a vertex if
not all are floats, given in whichever type, or if the largest coordinate is beyond 2^40 or below 2^-40. The 24
bytes, and 12 of the 62, are what it borrows if it may.*/
    pub fn rg_shape_create_mesh(
        config: *const rg_shape_config,
        views: *const rg_mesh_views,
        shape: *mut *mut rg_shape,
    ) -> rg_result;
}
unsafe extern "C" {
    /**A mesh of the triangles of another one with new vertices, for meshes that change their form: made much faster than
by rg\_shape\_create\_mesh. Of `views` only the vertices are read, as many as `mesh` has, and copied or borrowed: the
triangles are those of `mesh`, which stays as it is and may be released afterwards with all that it has borrowed;
rg\_scene\_replace\_shape puts the new one in its place.
What finds the triangles is taken over and fitted, unless triangles have moved so much against each other, in this
and earlier such steps, that rays would cost half as much again: then it is made anew, as config says. No answer
depends on which of the two. Errors: as rg\_shape\_create\_mesh; RG\_INVALID\_ARGUMENT: `mesh` is no mesh;
RG\_INVALID\_VALUE: another number of vertices. Cost: linear.*/
    pub fn rg_shape_create_deformed(
        config: *const rg_shape_config,
        mesh: *const rg_shape,
        views: *const rg_mesh_views,
        shape: *mut *mut rg_shape,
    ) -> rg_result;
}
///A ray as a user-defined shape sees it: origin + t \* direction, in the shape's local frame.
#[repr(C)]
#[derive(Debug, Default, Copy, Clone)]
pub struct rg_local_ray {
    pub origin: [f64; 3usize],
    pub direction: [f64; 3usize],
    pub t_min: f64,
    pub t_max: f64,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_local_ray"][::core::mem::size_of::<rg_local_ray>() - 64usize];
    ["Alignment of rg_local_ray"][::core::mem::align_of::<rg_local_ray>() - 8usize];
    [
        "Offset of field: rg_local_ray::origin",
    ][::core::mem::offset_of!(rg_local_ray, origin) - 0usize];
    [
        "Offset of field: rg_local_ray::direction",
    ][::core::mem::offset_of!(rg_local_ray, direction) - 24usize];
    [
        "Offset of field: rg_local_ray::t_min",
    ][::core::mem::offset_of!(rg_local_ray, t_min) - 48usize];
    [
        "Offset of field: rg_local_ray::t_max",
    ][::core::mem::offset_of!(rg_local_ray, t_max) - 56usize];
};
///What a user-defined shape reports of a hit.
#[repr(C)]
#[derive(Debug, Default, Copy, Clone)]
pub struct rg_local_hit {
    pub t: f64,
    pub normal: [f64; 3usize],
    pub u: f64,
    pub v: f64,
    pub primitive: u32,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_local_hit"][::core::mem::size_of::<rg_local_hit>() - 56usize];
    ["Alignment of rg_local_hit"][::core::mem::align_of::<rg_local_hit>() - 8usize];
    [
        "Offset of field: rg_local_hit::t",
    ][::core::mem::offset_of!(rg_local_hit, t) - 0usize];
    [
        "Offset of field: rg_local_hit::normal",
    ][::core::mem::offset_of!(rg_local_hit, normal) - 8usize];
    [
        "Offset of field: rg_local_hit::u",
    ][::core::mem::offset_of!(rg_local_hit, u) - 32usize];
    [
        "Offset of field: rg_local_hit::v",
    ][::core::mem::offset_of!(rg_local_hit, v) - 40usize];
    [
        "Offset of field: rg_local_hit::primitive",
    ][::core::mem::offset_of!(rg_local_hit, primitive) - 48usize];
};
/**A shape that the host intersects. The callbacks may be called from several threads at once; they may trace (any
scene) but must not change a scene in which the shape is used: such calls return RG\_BUSY.*/
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_user_shape {
    pub size: usize,
    ///Handed to each callback.
    pub user: *mut ::core::ffi::c_void,
    ///The local box that holds the shape, lo \<= hi, finite.
    pub lo: [f64; 3usize],
    ///The local box that holds the shape, lo \<= hi, finite.
    pub hi: [f64; 3usize],
    /**Finds the hit with the smallest t in \[ray-\>t\_min, ray-\>t\_max\]. Returns 1 and fills all of `hit`, or 0 for none
(`hit` is then ignored), or a negative number for a failure: the trace then returns RG\_CALLBACK\_FAILED. A t
outside the range counts as none. Where a hit does not count (culling, a filter), it is called again with t\_min
just beyond it; more than 1024 such hits of one ray count as a failure. The ray it sees may have its origin
moved along it and its direction scaled by a power of two, t\_min and t\_max with them, so that nothing loses
precision far away. Required.*/
    pub intersect: ::core::option::Option<
        unsafe extern "C" fn(
            user: *mut ::core::ffi::c_void,
            ray: *const rg_local_ray,
            hit: *mut rg_local_hit,
        ) -> i32,
    >,
    ///Whether there is any hit in the range; the same returns. NULL: intersect is asked.
    pub occluded: ::core::option::Option<
        unsafe extern "C" fn(
            user: *mut ::core::ffi::c_void,
            ray: *const rg_local_ray,
        ) -> i32,
    >,
    /**Called once when the last reference has gone, by the thread that gave it back, when the call of it on a scene
is done: it may use any scene but one that is being destroyed. May be NULL.*/
    pub destroy: ::core::option::Option<
        unsafe extern "C" fn(user: *mut ::core::ffi::c_void),
    >,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_user_shape"][::core::mem::size_of::<rg_user_shape>() - 88usize];
    ["Alignment of rg_user_shape"][::core::mem::align_of::<rg_user_shape>() - 8usize];
    [
        "Offset of field: rg_user_shape::size",
    ][::core::mem::offset_of!(rg_user_shape, size) - 0usize];
    [
        "Offset of field: rg_user_shape::user",
    ][::core::mem::offset_of!(rg_user_shape, user) - 8usize];
    [
        "Offset of field: rg_user_shape::lo",
    ][::core::mem::offset_of!(rg_user_shape, lo) - 16usize];
    [
        "Offset of field: rg_user_shape::hi",
    ][::core::mem::offset_of!(rg_user_shape, hi) - 40usize];
    [
        "Offset of field: rg_user_shape::intersect",
    ][::core::mem::offset_of!(rg_user_shape, intersect) - 64usize];
    [
        "Offset of field: rg_user_shape::occluded",
    ][::core::mem::offset_of!(rg_user_shape, occluded) - 72usize];
    [
        "Offset of field: rg_user_shape::destroy",
    ][::core::mem::offset_of!(rg_user_shape, destroy) - 80usize];
};
impl Default for rg_user_shape {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
unsafe extern "C" {
    /**A user-defined shape. `definition` is copied; what `user` points at must live until destroy was called. If the call
fails, destroy is not called.
Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_VALUE, RG\_OUT\_OF\_MEMORY. Cost: one allocation.*/
    pub fn rg_shape_create_user(
        config: *const rg_shape_config,
        definition: *const rg_user_shape,
        shape: *mut *mut rg_shape,
    ) -> rg_result;
}
///What kind of geometry a shape is.
pub type rg_shape_kind = i32;
pub const RG_SHAPE_SPHERE: i32 = 0;
pub const RG_SHAPE_BOX: i32 = 1;
pub const RG_SHAPE_CAPSULE: i32 = 2;
pub const RG_SHAPE_MESH: i32 = 3;
pub const RG_SHAPE_USER: i32 = 4;
///What is known of a shape. Set `size` before the call; the library fills what both sides know.
#[repr(C)]
#[derive(Debug, Default, Copy, Clone)]
pub struct rg_shape_report {
    pub size: usize,
    pub kind: rg_shape_kind,
    pub lo: [f64; 3usize],
    pub hi: [f64; 3usize],
    pub triangle_count: u64,
    pub bytes: u64,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_shape_report"][::core::mem::size_of::<rg_shape_report>() - 80usize];
    [
        "Alignment of rg_shape_report",
    ][::core::mem::align_of::<rg_shape_report>() - 8usize];
    [
        "Offset of field: rg_shape_report::size",
    ][::core::mem::offset_of!(rg_shape_report, size) - 0usize];
    [
        "Offset of field: rg_shape_report::kind",
    ][::core::mem::offset_of!(rg_shape_report, kind) - 8usize];
    [
        "Offset of field: rg_shape_report::lo",
    ][::core::mem::offset_of!(rg_shape_report, lo) - 16usize];
    [
        "Offset of field: rg_shape_report::hi",
    ][::core::mem::offset_of!(rg_shape_report, hi) - 40usize];
    [
        "Offset of field: rg_shape_report::triangle_count",
    ][::core::mem::offset_of!(rg_shape_report, triangle_count) - 64usize];
    [
        "Offset of field: rg_shape_report::bytes",
    ][::core::mem::offset_of!(rg_shape_report, bytes) - 72usize];
};
unsafe extern "C" {
    ///Fills `report`. RG\_INVALID\_ARGUMENT: a NULL pointer or an unknown size.
    pub fn rg_shape_stats(
        shape: *const rg_shape,
        report: *mut rg_shape_report,
    ) -> rg_result;
}
unsafe extern "C" {
    ///Adds a reference. NULL is ignored.
    pub fn rg_shape_retain(shape: *mut rg_shape);
}
unsafe extern "C" {
    ///Gives one reference back and sets the pointer to NULL. NULL, or a pointer to NULL, is ignored.
    pub fn rg_shape_release(shape: *mut *mut rg_shape);
}
///A grid of a scene, by value. Carries a generation: the id of a destroyed grid is refused.
pub type rg_grid = u32;
///How a grid stores its objects.
pub type rg_grid_kind = i32;
///What suits most scenes: the loose kind.
pub const RG_GRID_DEFAULT: i32 = 0;
///One level of cells; an object is listed in every cell that it overlaps. For objects of like size.
pub const RG_GRID_UNIFORM: i32 = 1;
/**Levels of cells, each twice as wide as the level below; an object is listed at the level whose cells are no
smaller than it, so in at most 8 cells. Insert, move and remove cost the same whatever the sizes.*/
pub const RG_GRID_HIERARCHICAL: i32 = 2;
/**A lattice of cells, each half as wide as the one above it, made where objects are. An object is stored once, by
its centre, in a cell that fits its size; tight boxes around what is stored decide what a ray looks into. Cells
hold floats, relative to an origin and a unit that were chosen from the objects. It has no box that objects
could leave: resolution, lo, hi and rebuild\_factor have no meaning, and it is made anew by itself only when all
objects have drifted four radii of the whole away from that origin, or when many are out of floats' reach.*/
pub const RG_GRID_LOOSE: i32 = 3;
///How a grid is made.
#[repr(C)]
#[derive(Debug, Default, Copy, Clone)]
pub struct rg_grid_config {
    pub size: usize,
    pub kind: rg_grid_kind,
    /**Cells along the longest side of the physical box, at the finest level; the other sides have as many as fit, at
least one. The hierarchical kind rounds up to a power of two on each side. 0: from the number of objects, anew
at each rebuild. At most 2^20; and at most 2^28 cells in all.*/
    pub resolution: u32,
    /**The first physical box; hi - lo at least RG\_RADIUS\_MIN. All six 0: from the objects, when the first are
inserted. A rebuild makes a new box from the objects, unless it only adapts an automatic resolution: then a box
that was given stays.*/
    pub lo: [f64; 3usize],
    /**The first physical box; hi - lo at least RG\_RADIUS\_MIN. All six 0: from the objects, when the first are
inserted. A rebuild makes a new box from the objects, unless it only adapts an automatic resolution: then a box
that was given stays.*/
    pub hi: [f64; 3usize],
    /**Rebuild when the logical diagonal exceeds the physical one by this factor: \>= 1, 0 for the default of 2, or
RG\_REBUILD\_NEVER. An automatic resolution is also adapted at such times, never with RG\_REBUILD\_NEVER.*/
    pub rebuild_factor: f64,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_grid_config"][::core::mem::size_of::<rg_grid_config>() - 72usize];
    ["Alignment of rg_grid_config"][::core::mem::align_of::<rg_grid_config>() - 8usize];
    [
        "Offset of field: rg_grid_config::size",
    ][::core::mem::offset_of!(rg_grid_config, size) - 0usize];
    [
        "Offset of field: rg_grid_config::kind",
    ][::core::mem::offset_of!(rg_grid_config, kind) - 8usize];
    [
        "Offset of field: rg_grid_config::resolution",
    ][::core::mem::offset_of!(rg_grid_config, resolution) - 12usize];
    [
        "Offset of field: rg_grid_config::lo",
    ][::core::mem::offset_of!(rg_grid_config, lo) - 16usize];
    [
        "Offset of field: rg_grid_config::hi",
    ][::core::mem::offset_of!(rg_grid_config, hi) - 40usize];
    [
        "Offset of field: rg_grid_config::rebuild_factor",
    ][::core::mem::offset_of!(rg_grid_config, rebuild_factor) - 64usize];
};
unsafe extern "C" {
    /**Fills `config` with the defaults: RG\_GRID\_DEFAULT, automatic resolution and box, factor 2. `size` is
sizeof(rg\_grid\_config) at the caller's. RG\_INVALID\_ARGUMENT: config is NULL or the size unknown.*/
    pub fn rg_grid_config_default(config: *mut rg_grid_config, size: usize) -> rg_result;
}
///What is known of a grid. Set `size` before the call; the library fills what both sides know.
#[repr(C)]
#[derive(Debug, Default, Copy, Clone)]
pub struct rg_grid_report {
    pub size: usize,
    pub kind: rg_grid_kind,
    pub levels: u32,
    pub levels_used: u32,
    pub resolution: [u32; 3usize],
    pub physical_lo: [f64; 3usize],
    pub physical_hi: [f64; 3usize],
    pub logical_lo: [f64; 3usize],
    pub logical_hi: [f64; 3usize],
    pub objects: u64,
    pub entries: u64,
    pub unbounded: u64,
    pub tiles: u64,
    pub rebuilds: u64,
    pub rebuilding: u32,
    pub reserved: u32,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_grid_report"][::core::mem::size_of::<rg_grid_report>() - 176usize];
    ["Alignment of rg_grid_report"][::core::mem::align_of::<rg_grid_report>() - 8usize];
    [
        "Offset of field: rg_grid_report::size",
    ][::core::mem::offset_of!(rg_grid_report, size) - 0usize];
    [
        "Offset of field: rg_grid_report::kind",
    ][::core::mem::offset_of!(rg_grid_report, kind) - 8usize];
    [
        "Offset of field: rg_grid_report::levels",
    ][::core::mem::offset_of!(rg_grid_report, levels) - 12usize];
    [
        "Offset of field: rg_grid_report::levels_used",
    ][::core::mem::offset_of!(rg_grid_report, levels_used) - 16usize];
    [
        "Offset of field: rg_grid_report::resolution",
    ][::core::mem::offset_of!(rg_grid_report, resolution) - 20usize];
    [
        "Offset of field: rg_grid_report::physical_lo",
    ][::core::mem::offset_of!(rg_grid_report, physical_lo) - 32usize];
    [
        "Offset of field: rg_grid_report::physical_hi",
    ][::core::mem::offset_of!(rg_grid_report, physical_hi) - 56usize];
    [
        "Offset of field: rg_grid_report::logical_lo",
    ][::core::mem::offset_of!(rg_grid_report, logical_lo) - 80usize];
    [
        "Offset of field: rg_grid_report::logical_hi",
    ][::core::mem::offset_of!(rg_grid_report, logical_hi) - 104usize];
    [
        "Offset of field: rg_grid_report::objects",
    ][::core::mem::offset_of!(rg_grid_report, objects) - 128usize];
    [
        "Offset of field: rg_grid_report::entries",
    ][::core::mem::offset_of!(rg_grid_report, entries) - 136usize];
    [
        "Offset of field: rg_grid_report::unbounded",
    ][::core::mem::offset_of!(rg_grid_report, unbounded) - 144usize];
    [
        "Offset of field: rg_grid_report::tiles",
    ][::core::mem::offset_of!(rg_grid_report, tiles) - 152usize];
    [
        "Offset of field: rg_grid_report::rebuilds",
    ][::core::mem::offset_of!(rg_grid_report, rebuilds) - 160usize];
    [
        "Offset of field: rg_grid_report::rebuilding",
    ][::core::mem::offset_of!(rg_grid_report, rebuilding) - 168usize];
    [
        "Offset of field: rg_grid_report::reserved",
    ][::core::mem::offset_of!(rg_grid_report, reserved) - 172usize];
};
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_scene {
    _unused: [u8; 0],
}
/**An object of a scene, by value. The low 32 bits are its slot, a small number that is used again after a remove and
so fits as index into arrays of the host; the high 32 bits count the uses of that slot from 1 up. A slot whose
count is used up is retired, so an id never comes back.*/
pub type rg_object = u64;
///How a scene is made. NULL in place of it means all defaults.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_scene_config {
    pub size: usize,
    /**Threads that trace large calls together, the calling one among them: 0 for one a processor, 1 for the calling
thread alone (no thread is made), at most 1024. Ignored with parallel\_for. A library that was built without
threads takes any as 1.*/
    pub workers: u32,
    pub reserved: u32,
    ///Where the scene's memory comes from; both functions NULL: malloc. Copied.
    pub allocator: rg_allocator,
    ///The host's job system in place of workers; then no thread is made. NULL: workers.
    pub parallel_for: rg_parallel_for,
    pub parallel_for_user: *mut ::core::ffi::c_void,
    /**Told when a grid is rebuilt, or could not be for want of memory. NULL: nobody. Called by whichever thread does
it, also a worker, in the midst of it: it must not use the scene.*/
    pub log: rg_log,
    pub log_user: *mut ::core::ffi::c_void,
    ///How RG\_GRID\_OF\_SCENE is made. NULL: defaults. Read during the call only.
    pub grid: *const rg_grid_config,
    /**Bytes that the scene may hold from its allocator (rg\_scene\_report.bytes); 0: no limit. What would need more
gives RG\_OUT\_OF\_MEMORY, as if the allocator had none. Shapes are not counted.*/
    pub memory_limit: u64,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_scene_config"][::core::mem::size_of::<rg_scene_config>() - 88usize];
    [
        "Alignment of rg_scene_config",
    ][::core::mem::align_of::<rg_scene_config>() - 8usize];
    [
        "Offset of field: rg_scene_config::size",
    ][::core::mem::offset_of!(rg_scene_config, size) - 0usize];
    [
        "Offset of field: rg_scene_config::workers",
    ][::core::mem::offset_of!(rg_scene_config, workers) - 8usize];
    [
        "Offset of field: rg_scene_config::reserved",
    ][::core::mem::offset_of!(rg_scene_config, reserved) - 12usize];
    [
        "Offset of field: rg_scene_config::allocator",
    ][::core::mem::offset_of!(rg_scene_config, allocator) - 16usize];
    [
        "Offset of field: rg_scene_config::parallel_for",
    ][::core::mem::offset_of!(rg_scene_config, parallel_for) - 40usize];
    [
        "Offset of field: rg_scene_config::parallel_for_user",
    ][::core::mem::offset_of!(rg_scene_config, parallel_for_user) - 48usize];
    [
        "Offset of field: rg_scene_config::log",
    ][::core::mem::offset_of!(rg_scene_config, log) - 56usize];
    [
        "Offset of field: rg_scene_config::log_user",
    ][::core::mem::offset_of!(rg_scene_config, log_user) - 64usize];
    [
        "Offset of field: rg_scene_config::grid",
    ][::core::mem::offset_of!(rg_scene_config, grid) - 72usize];
    [
        "Offset of field: rg_scene_config::memory_limit",
    ][::core::mem::offset_of!(rg_scene_config, memory_limit) - 80usize];
};
impl Default for rg_scene_config {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
unsafe extern "C" {
    /**Fills `config` with the defaults. `size` is sizeof(rg\_scene\_config) at the caller's.
RG\_INVALID\_ARGUMENT: config is NULL or the size unknown.*/
    pub fn rg_scene_config_default(
        config: *mut rg_scene_config,
        size: usize,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Makes an empty scene. The caller owns it and ends it with rg\_scene\_destroy.
Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_VALUE, RG\_OUT\_OF\_MEMORY, RG\_OUT\_OF\_THREADS.*/
    pub fn rg_scene_create(
        config: *const rg_scene_config,
        scene: *mut *mut rg_scene,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Ends the scene, its workers, and its objects' references to their shapes; sets the pointer to NULL. Waits for calls
that other threads have begun on it; none may follow. NULL, or a pointer to NULL, is ignored and RG\_OK.
RG\_BUSY: called from inside a callback of this scene, or it has frames; the scene lives on.*/
    pub fn rg_scene_destroy(scene: *mut *mut rg_scene) -> rg_result;
}
/**Where an object is: world = position + scale \* linear \* local. Any invertible linear part: rotation, scale, mirror,
shear. `linear` is stored by rows. The library computes with exactly the numbers given, the product of scale and
linear rounded to double. The posed shape must not reach beyond 4 \* RG\_COORDINATE\_MAX, infinite boxes excepted.
Spheres of any radius need one shape only: a scale each. A sphere without a linear part of its own takes least
memory and time; its radius times the scale must be in \[RG\_RADIUS\_MIN, RG\_COORDINATE\_MAX\].*/
#[repr(C)]
#[derive(Debug, Default, Copy, Clone)]
pub struct rg_pose {
    pub position: [f64; 3usize],
    pub linear: [f32; 9usize],
    pub scale: f64,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_pose"][::core::mem::size_of::<rg_pose>() - 72usize];
    ["Alignment of rg_pose"][::core::mem::align_of::<rg_pose>() - 8usize];
    [
        "Offset of field: rg_pose::position",
    ][::core::mem::offset_of!(rg_pose, position) - 0usize];
    [
        "Offset of field: rg_pose::linear",
    ][::core::mem::offset_of!(rg_pose, linear) - 24usize];
    [
        "Offset of field: rg_pose::scale",
    ][::core::mem::offset_of!(rg_pose, scale) - 64usize];
};
unsafe extern "C" {
    ///The pose that only moves: identity as linear part, scale 1.
    pub fn rg_pose_at(x: f64, y: f64, z: f64) -> rg_pose;
}
///Poses of many objects, for calls on many. Zero it, set the size, then what is given.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_pose_views {
    pub size: usize,
    pub position: rg_input3,
    /**The linear parts by columns: column\[j\] views the world image of the local unit vector j. RG\_F64 (rounded to
float) or RG\_F32. Give all three or none; none: insert takes the identity, move keeps what each object has.*/
    pub column: [rg_input3; 3usize],
    ///RG\_F64 or RG\_F32. Not given: insert takes 1, move keeps what each object has.
    pub scale: rg_input,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_pose_views"][::core::mem::size_of::<rg_pose_views>() - 192usize];
    ["Alignment of rg_pose_views"][::core::mem::align_of::<rg_pose_views>() - 8usize];
    [
        "Offset of field: rg_pose_views::size",
    ][::core::mem::offset_of!(rg_pose_views, size) - 0usize];
    [
        "Offset of field: rg_pose_views::position",
    ][::core::mem::offset_of!(rg_pose_views, position) - 8usize];
    [
        "Offset of field: rg_pose_views::column",
    ][::core::mem::offset_of!(rg_pose_views, column) - 48usize];
    [
        "Offset of field: rg_pose_views::scale",
    ][::core::mem::offset_of!(rg_pose_views, scale) - 168usize];
};
impl Default for rg_pose_views {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
unsafe extern "C" {
    /**Fills `views`, of `size` bytes at the caller's, with the views of an array of rg\_pose: the first at `poses`, each
`stride` bytes after the last; 0: all the same. RG\_INVALID\_ARGUMENT: a NULL pointer or an unknown size.*/
    pub fn rg_pose_views_of(
        views: *mut rg_pose_views,
        size: usize,
        poses: *const rg_pose,
        stride: isize,
    ) -> rg_result;
}
///What rg\_scene\_insert\_many inserts. Zero it, set the size, then what is given.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_insert_views {
    pub size: usize,
    pub shapes: *const ::core::ffi::c_void,
    pub shapes_stride: isize,
    pub poses: *const rg_pose_views,
    pub mask: rg_input,
    pub grid: rg_grid,
    pub reserved: u32,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_insert_views"][::core::mem::size_of::<rg_insert_views>() - 64usize];
    [
        "Alignment of rg_insert_views",
    ][::core::mem::align_of::<rg_insert_views>() - 8usize];
    [
        "Offset of field: rg_insert_views::size",
    ][::core::mem::offset_of!(rg_insert_views, size) - 0usize];
    [
        "Offset of field: rg_insert_views::shapes",
    ][::core::mem::offset_of!(rg_insert_views, shapes) - 8usize];
    [
        "Offset of field: rg_insert_views::shapes_stride",
    ][::core::mem::offset_of!(rg_insert_views, shapes_stride) - 16usize];
    [
        "Offset of field: rg_insert_views::poses",
    ][::core::mem::offset_of!(rg_insert_views, poses) - 24usize];
    [
        "Offset of field: rg_insert_views::mask",
    ][::core::mem::offset_of!(rg_insert_views, mask) - 32usize];
    [
        "Offset of field: rg_insert_views::grid",
    ][::core::mem::offset_of!(rg_insert_views, grid) - 56usize];
    [
        "Offset of field: rg_insert_views::reserved",
    ][::core::mem::offset_of!(rg_insert_views, reserved) - 60usize];
};
impl Default for rg_insert_views {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
unsafe extern "C" {
    /**Inserts an object into the scene's own grid; its mask has all bits set. The next trace sees it. The object holds a
reference to the shape. `pose` NULL: at the origin. `object` NULL: the id is not wanted.
Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_VALUE (pose), RG\_LIMIT\_EXCEEDED (2^32 - 1 slots used), RG\_OUT\_OF\_MEMORY,
RG\_BUSY. Cost: constant; rebuilds of the grid are spread over many calls on average, see raygrid/grid.h.*/
    pub fn rg_scene_insert(
        scene: *mut rg_scene,
        shape: *mut rg_shape,
        pose: *const rg_pose,
        object: *mut rg_object,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Inserts `count` objects at once: all, or on any error none. `objects` receives their ids, RG\_U64, or is not given.
Errors: as rg\_scene\_insert; RG\_INVALID\_ID (grid). The message names the index of the first bad one.*/
    pub fn rg_scene_insert_many(
        scene: *mut rg_scene,
        views: *const rg_insert_views,
        count: u64,
        objects: *const rg_output,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Gives an object a new pose. The next trace sees it. Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_ID, RG\_INVALID\_VALUE,
RG\_OUT\_OF\_MEMORY, RG\_BUSY; the object then keeps its pose. Cost: constant; least while it stays in its cells.*/
    pub fn rg_scene_move(
        scene: *mut rg_scene,
        object: rg_object,
        pose: *const rg_pose,
    ) -> rg_result;
}
unsafe extern "C" {
    ///Gives an object a new position and keeps its linear part and scale. Otherwise as rg\_scene\_move.
    pub fn rg_scene_move_to(
        scene: *mut rg_scene,
        object: rg_object,
        position: *const f64,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Moves `count` objects at once: all, or on any error none. `objects` views their ids, RG\_U64. An object named twice
ends at its last pose. Errors: as rg\_scene\_move; the message names the index of the first bad one. Takes some 90
bytes an object from the scene's allocator while it runs.*/
    pub fn rg_scene_move_many(
        scene: *mut rg_scene,
        objects: *const rg_input,
        poses: *const rg_pose_views,
        count: u64,
    ) -> rg_result;
}
unsafe extern "C" {
    ///Changes which rays see an object: those with (ray mask & mask) != 0. Errors: RG\_INVALID\_ID, RG\_BUSY.
    pub fn rg_scene_set_mask(
        scene: *mut rg_scene,
        object: rg_object,
        mask: u32,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Removes an object; its id is stale from now on. Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_ID, RG\_BUSY. Cost:
constant.*/
    pub fn rg_scene_remove(scene: *mut rg_scene, object: rg_object) -> rg_result;
}
unsafe extern "C" {
    /**Removes `count` objects at once: all, or on any error (an id that is stale or given twice) none. `objects` views
their ids, RG\_U64. Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_ID (the message names the index), RG\_BUSY.*/
    pub fn rg_scene_remove_many(
        scene: *mut rg_scene,
        objects: *const rg_input,
        count: u64,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Gives every object of this scene that has the shape `from` the shape `to`: as for a mesh that has changed its form,
see rg\_shape\_create\_deformed. Their ids, poses and masks stay. All at once, or on any error none: each ray sees all
with the one or all with the other. Objects of other scenes keep `from`.
Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_VALUE (an object with `to` would reach too far; the message names it),
RG\_OUT\_OF\_MEMORY, RG\_BUSY. Cost: looks at each object of the scene, some nanoseconds each; moves those concerned.*/
    pub fn rg_scene_replace_shape(
        scene: *mut rg_scene,
        from: *mut rg_shape,
        to: *mut rg_shape,
    ) -> rg_result;
}
///What is known of an object. Set `size` before the call; the library fills what both sides know.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_object_report {
    pub size: usize,
    pub pose: rg_pose,
    pub shape: *mut rg_shape,
    pub mask: u32,
    pub grid: rg_grid,
    pub lo: [f64; 3usize],
    pub hi: [f64; 3usize],
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_object_report"][::core::mem::size_of::<rg_object_report>() - 144usize];
    [
        "Alignment of rg_object_report",
    ][::core::mem::align_of::<rg_object_report>() - 8usize];
    [
        "Offset of field: rg_object_report::size",
    ][::core::mem::offset_of!(rg_object_report, size) - 0usize];
    [
        "Offset of field: rg_object_report::pose",
    ][::core::mem::offset_of!(rg_object_report, pose) - 8usize];
    [
        "Offset of field: rg_object_report::shape",
    ][::core::mem::offset_of!(rg_object_report, shape) - 80usize];
    [
        "Offset of field: rg_object_report::mask",
    ][::core::mem::offset_of!(rg_object_report, mask) - 88usize];
    [
        "Offset of field: rg_object_report::grid",
    ][::core::mem::offset_of!(rg_object_report, grid) - 92usize];
    [
        "Offset of field: rg_object_report::lo",
    ][::core::mem::offset_of!(rg_object_report, lo) - 96usize];
    [
        "Offset of field: rg_object_report::hi",
    ][::core::mem::offset_of!(rg_object_report, hi) - 120usize];
};
impl Default for rg_object_report {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
unsafe extern "C" {
    ///Looks an object up. Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_ID. Cost: constant.
    pub fn rg_scene_lookup(
        scene: *mut rg_scene,
        object: rg_object,
        report: *mut rg_object_report,
    ) -> rg_result;
}
unsafe extern "C" {
    /**The shape of an object, with a reference for the caller. Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_ID. Cost:
constant.*/
    pub fn rg_scene_shape_of(
        scene: *mut rg_scene,
        object: rg_object,
        shape: *mut *mut rg_shape,
    ) -> rg_result;
}
///The instructions that the kernels of a scene use: the best that were built and that the processor has.
pub type rg_isa = i32;
pub const RG_ISA_PORTABLE: i32 = 0;
pub const RG_ISA_SSE2: i32 = 1;
pub const RG_ISA_AVX2: i32 = 2;
pub const RG_ISA_AVX512: i32 = 3;
pub const RG_ISA_NEON: i32 = 4;
pub const RG_WITHOUT_BOXES: i32 = 1;
pub const RG_WITHOUT_MASKS: i32 = 2;
pub const RG_WITHOUT_UNBOUNDED: i32 = 4;
pub const RG_WITHOUT_TILES: i32 = 8;
pub const RG_WITHOUT_LEVELS: i32 = 16;
pub const RG_WITHOUT_GRIDS: i32 = 32;
pub const RG_WITHOUT_THREADS: i32 = 64;
///What traces of a scene do without, because it holds nothing that needs it. Bits, as the scene is now.
///What is known of a scene. Set `size` before the call; the library fills what both sides know.
#[repr(C)]
#[derive(Debug, Default, Copy, Clone)]
pub struct rg_scene_report {
    pub size: usize,
    pub objects: u64,
    pub slots: u64,
    pub bytes: u64,
    pub invalid_rays: u64,
    pub workers: u32,
    pub grids: u32,
    pub isa: rg_isa,
    pub left_out: u32,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_scene_report"][::core::mem::size_of::<rg_scene_report>() - 56usize];
    [
        "Alignment of rg_scene_report",
    ][::core::mem::align_of::<rg_scene_report>() - 8usize];
    [
        "Offset of field: rg_scene_report::size",
    ][::core::mem::offset_of!(rg_scene_report, size) - 0usize];
    [
        "Offset of field: rg_scene_report::objects",
    ][::core::mem::offset_of!(rg_scene_report, objects) - 8usize];
    [
        "Offset of field: rg_scene_report::slots",
    ][::core::mem::offset_of!(rg_scene_report, slots) - 16usize];
    [
        "Offset of field: rg_scene_report::bytes",
    ][::core::mem::offset_of!(rg_scene_report, bytes) - 24usize];
    [
        "Offset of field: rg_scene_report::invalid_rays",
    ][::core::mem::offset_of!(rg_scene_report, invalid_rays) - 32usize];
    [
        "Offset of field: rg_scene_report::workers",
    ][::core::mem::offset_of!(rg_scene_report, workers) - 40usize];
    [
        "Offset of field: rg_scene_report::grids",
    ][::core::mem::offset_of!(rg_scene_report, grids) - 44usize];
    [
        "Offset of field: rg_scene_report::isa",
    ][::core::mem::offset_of!(rg_scene_report, isa) - 48usize];
    [
        "Offset of field: rg_scene_report::left_out",
    ][::core::mem::offset_of!(rg_scene_report, left_out) - 52usize];
};
unsafe extern "C" {
    ///Fills `report`. Errors: RG\_INVALID\_ARGUMENT.
    pub fn rg_scene_stats(
        scene: *mut rg_scene,
        report: *mut rg_scene_report,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Makes a frame of a scene: a scene that holds what `scene` held at one instant, under the same ids, and stays like
that while `scene` goes on to change; until rg\_scene\_update\_frame. It is traced, read and destroyed like any scene.
All that would change it gives RG\_BUSY. Its shapes are those of the scene; what the scene's grids are its grids
are, and `config-\>grid` is not used. `scene` can't be destroyed before its frames. Errors: as rg\_scene\_create;
RG\_BUSY (from inside a callback of the scene). Cost: linear in the objects, and their memory once more; each change
of the scene takes a few ns more then.*/
    pub fn rg_scene_create_frame(
        scene: *mut rg_scene,
        config: *const rg_scene_config,
        frame: *mut *mut rg_scene,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Takes over what has changed in the scene since the last update: all of one instant. Traces of the frame see it
whole or not at all, as a change; the scene is held only while its changes are copied, and as by a trace. Errors:
RG\_INVALID\_ARGUMENT (it is no frame), RG\_BUSY (from inside a callback of the frame), RG\_OUT\_OF\_MEMORY: then each
object is where it was at the last or at this update, and the next one makes up for it. Cost: that of moving what
has changed, each object once.*/
    pub fn rg_scene_update_frame(frame: *mut rg_scene) -> rg_result;
}
unsafe extern "C" {
    /**Adds an empty grid. Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_VALUE, RG\_LIMIT\_EXCEEDED (more than 256 grids with the
scene's own, or more than 2^28 cells), RG\_OUT\_OF\_MEMORY, RG\_BUSY.*/
    pub fn rg_grid_create(
        scene: *mut rg_scene,
        config: *const rg_grid_config,
        grid: *mut rg_grid,
    ) -> rg_result;
}
unsafe extern "C" {
    ///Destroys an empty grid. Errors: RG\_INVALID\_ID, RG\_BUSY (it holds objects, is the scene's own, or in a callback).
    pub fn rg_grid_destroy(scene: *mut rg_scene, grid: rg_grid) -> rg_result;
}
unsafe extern "C" {
    /**Changes kind, resolution, box or factor of a grid that may hold objects, and rebuilds it. Errors: as
rg\_grid\_create, RG\_INVALID\_ID; the grid is then as it was. Cost: linear in its objects.*/
    pub fn rg_grid_configure(
        scene: *mut rg_scene,
        grid: rg_grid,
        config: *const rg_grid_config,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Rebuilds a grid now, with a physical box and resolution that fit its objects, whatever its rebuild\_factor.
Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_ID, RG\_OUT\_OF\_MEMORY (the grid is then as it was), RG\_BUSY.
Cost: linear in its objects.*/
    pub fn rg_grid_rebuild(scene: *mut rg_scene, grid: rg_grid) -> rg_result;
}
unsafe extern "C" {
    ///Fills `report`. Errors: RG\_INVALID\_ARGUMENT, RG\_INVALID\_ID.
    pub fn rg_grid_stats(
        scene: *mut rg_scene,
        grid: rg_grid,
        report: *mut rg_grid_report,
    ) -> rg_result;
}
/**Takes the next bytes, all of them. 0: done; any other number is a failure, and the callback is not called again.
Called with the scene held: from inside it the scene may be traced and read; calls that would change it return
RG\_BUSY.*/
pub type rg_write = ::core::option::Option<
    unsafe extern "C" fn(
        user: *mut ::core::ffi::c_void,
        bytes: *const ::core::ffi::c_void,
        size: usize,
    ) -> i32,
>;
/**Gives a user-defined shape a number by which rg\_find\_shape will know it. `shape\_user` is the `user` of its
rg\_user\_shape. 0: \*number is set; any other number: there is none, and the shape can't be written.*/
pub type rg_number_shape = ::core::option::Option<
    unsafe extern "C" fn(
        user: *mut ::core::ffi::c_void,
        shape: *const rg_shape,
        shape_user: *mut ::core::ffi::c_void,
        number: *mut u64,
    ) -> i32,
>;
///Where bytes go. Zero it, set the size, then what is given.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_sink {
    pub size: usize,
    ///Handed to the callbacks.
    pub user: *mut ::core::ffi::c_void,
    ///Required.
    pub write: rg_write,
    ///NULL: user-defined shapes can't be written.
    pub number_shape: rg_number_shape,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_sink"][::core::mem::size_of::<rg_sink>() - 32usize];
    ["Alignment of rg_sink"][::core::mem::align_of::<rg_sink>() - 8usize];
    ["Offset of field: rg_sink::size"][::core::mem::offset_of!(rg_sink, size) - 0usize];
    ["Offset of field: rg_sink::user"][::core::mem::offset_of!(rg_sink, user) - 8usize];
    [
        "Offset of field: rg_sink::write",
    ][::core::mem::offset_of!(rg_sink, write) - 16usize];
    [
        "Offset of field: rg_sink::number_shape",
    ][::core::mem::offset_of!(rg_sink, number_shape) - 24usize];
};
impl Default for rg_sink {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
/**Gives the user-defined shape of a number; `lo` and `hi` are the local box that it had when it was written, which it
must have again. The library takes over one reference: rg\_shape\_create\_user into `shape` does, and a host that
keeps the shape calls rg\_shape\_retain. 0: \*shape is set; any other number is a failure.*/
pub type rg_find_shape = ::core::option::Option<
    unsafe extern "C" fn(
        user: *mut ::core::ffi::c_void,
        number: u64,
        lo: *const f64,
        hi: *const f64,
        shape: *mut *mut rg_shape,
    ) -> i32,
>;
///Where bytes come from. Zero it, set the size, then what is given.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_source {
    pub size: usize,
    ///Required. At any address. They stay the host's, and must live as long as what reads them; so must `shapes`.
    pub bytes: *const ::core::ffi::c_void,
    pub byte_count: u64,
    ///Handed to find\_shape.
    pub user: *mut ::core::ffi::c_void,
    ///NULL: bytes with user-defined shapes are refused.
    pub find_shape: rg_find_shape,
    ///How all other shapes are made. NULL: defaults.
    pub shapes: *const rg_shape_config,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_source"][::core::mem::size_of::<rg_source>() - 48usize];
    ["Alignment of rg_source"][::core::mem::align_of::<rg_source>() - 8usize];
    [
        "Offset of field: rg_source::size",
    ][::core::mem::offset_of!(rg_source, size) - 0usize];
    [
        "Offset of field: rg_source::bytes",
    ][::core::mem::offset_of!(rg_source, bytes) - 8usize];
    [
        "Offset of field: rg_source::byte_count",
    ][::core::mem::offset_of!(rg_source, byte_count) - 16usize];
    [
        "Offset of field: rg_source::user",
    ][::core::mem::offset_of!(rg_source, user) - 24usize];
    [
        "Offset of field: rg_source::find_shape",
    ][::core::mem::offset_of!(rg_source, find_shape) - 32usize];
    [
        "Offset of field: rg_source::shapes",
    ][::core::mem::offset_of!(rg_source, shapes) - 40usize];
};
impl Default for rg_source {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
unsafe extern "C" {
    /**Writes a snapshot of the scene as it is. Traces go on meanwhile; changes wait. The same scene gives the same bytes.
Of a frame (rg\_scene\_create\_frame) too, without its scene waiting: loaded, that is a scene of its own, with the
same ids and answers, which uses free slots again from the lowest up. Errors: RG\_INVALID\_ARGUMENT (also for a
user-defined shape without a number; the message names an object that has it), RG\_CALLBACK\_FAILED (write failed),
RG\_OUT\_OF\_MEMORY. After an error some bytes may have been written; loading them will be refused. Cost: linear; some
40 bytes an object are written, and memory is taken for each different shape.*/
    pub fn rg_scene_save(scene: *mut rg_scene, sink: *const rg_sink) -> rg_result;
}
unsafe extern "C" {
    /**Makes a scene from a snapshot. `config` is as for rg\_scene\_create, but for its `grid`, which is ignored. The scene
holds the only references to its shapes.
Errors: as rg\_scene\_create; RG\_INVALID\_DATA (the message names the byte where something was wrong, and what);
RG\_CALLBACK\_FAILED (find\_shape failed, or gave another shape). Cost: as inserting all its objects at once.*/
    pub fn rg_scene_load(
        config: *const rg_scene_config,
        source: *const rg_source,
        scene: *mut *mut rg_scene,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Begins a recording: writes a snapshot, then hands each call that changes the scene to `write` before it returns,
mostly in one piece. Calls that fail change nothing and are not recorded. `sink` NULL ends the recording, if there
is one; so does rg\_scene\_destroy.

When the recording can't go on (write failed, no memory, a user-defined shape without a number), it ends; the call
that was to be recorded succeeds all the same, what has been written is good up to there, the scene's log is told,
and the call that ends the recording returns why. A recording holds a reference to each shape that it has written:
of a mesh that is given new vertices again and again, to all of them.
Errors when it begins: as rg\_scene\_save; RG\_BUSY (there is one, the scene is a frame, or from inside a callback).
When it ends: RG\_CALLBACK\_FAILED, RG\_OUT\_OF\_MEMORY, RG\_INVALID\_ARGUMENT, if it could not be written to its end; it
is over all the same. RG\_BUSY: from inside a callback.*/
    pub fn rg_scene_record(scene: *mut rg_scene, sink: *const rg_sink) -> rg_result;
}
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_replay {
    _unused: [u8; 0],
}
///The calls that change a scene.
pub type rg_call = i32;
pub const RG_CALL_NONE: i32 = 0;
pub const RG_CALL_INSERT: i32 = 1;
pub const RG_CALL_INSERT_MANY: i32 = 2;
pub const RG_CALL_MOVE: i32 = 3;
pub const RG_CALL_MOVE_TO: i32 = 4;
pub const RG_CALL_MOVE_MANY: i32 = 5;
pub const RG_CALL_SET_MASK: i32 = 6;
pub const RG_CALL_REMOVE: i32 = 7;
pub const RG_CALL_REMOVE_MANY: i32 = 8;
pub const RG_CALL_GRID_CREATE: i32 = 9;
pub const RG_CALL_GRID_DESTROY: i32 = 10;
pub const RG_CALL_GRID_CONFIGURE: i32 = 11;
pub const RG_CALL_GRID_REBUILD: i32 = 12;
pub const RG_CALL_REPLACE_SHAPE: i32 = 13;
unsafe extern "C" {
    ///The name of the function that makes a call, such as "rg\_scene\_insert"; "unknown" for a number that is none.
    pub fn rg_call_name(call: rg_call) -> *const ::core::ffi::c_char;
}
unsafe extern "C" {
    /**Makes the scene with which a recording begins, and a replay that plays it on that scene. Takes a snapshot, too:
then there is nothing to play. The scene is the caller's, to be traced, saved and destroyed; a change of it between
two steps is found when other ids come out. The bytes of `source` must live as long as the replay.
Errors: as rg\_scene\_load.*/
    pub fn rg_replay_create(
        config: *const rg_scene_config,
        source: *const rg_source,
        replay: *mut *mut rg_replay,
        scene: *mut *mut rg_scene,
    ) -> rg_result;
}
///What was played. Set `size` before the call; the library fills what both sides know.
#[repr(C)]
#[derive(Debug, Default, Copy, Clone)]
pub struct rg_replay_report {
    pub size: usize,
    pub calls: u64,
    pub offset: u64,
    pub objects: u64,
    pub object: rg_object,
    pub call: rg_call,
    pub grid: rg_grid,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_replay_report"][::core::mem::size_of::<rg_replay_report>() - 48usize];
    [
        "Alignment of rg_replay_report",
    ][::core::mem::align_of::<rg_replay_report>() - 8usize];
    [
        "Offset of field: rg_replay_report::size",
    ][::core::mem::offset_of!(rg_replay_report, size) - 0usize];
    [
        "Offset of field: rg_replay_report::calls",
    ][::core::mem::offset_of!(rg_replay_report, calls) - 8usize];
    [
        "Offset of field: rg_replay_report::offset",
    ][::core::mem::offset_of!(rg_replay_report, offset) - 16usize];
    [
        "Offset of field: rg_replay_report::objects",
    ][::core::mem::offset_of!(rg_replay_report, objects) - 24usize];
    [
        "Offset of field: rg_replay_report::object",
    ][::core::mem::offset_of!(rg_replay_report, object) - 32usize];
    [
        "Offset of field: rg_replay_report::call",
    ][::core::mem::offset_of!(rg_replay_report, call) - 40usize];
    [
        "Offset of field: rg_replay_report::grid",
    ][::core::mem::offset_of!(rg_replay_report, grid) - 44usize];
};
unsafe extern "C" {
    /**Plays the next call. Behind the last one it does nothing, and says so. `report` NULL: not wanted.
Errors: RG\_INVALID\_DATA (the bytes are damaged or cut off; the call fails on this scene, or gives another id than
it gave when it was recorded): the scene is as after the call before, unless an id was another. RG\_OUT\_OF\_MEMORY,
RG\_BUSY, RG\_CALLBACK\_FAILED (find\_shape): the step may be tried again.*/
    pub fn rg_replay_step(
        replay: *mut rg_replay,
        report: *mut rg_replay_report,
    ) -> rg_result;
}
unsafe extern "C" {
    /**Ends a replay, not its scene, which may have been destroyed before; sets the pointer to NULL. NULL, or a pointer
to NULL, is ignored.*/
    pub fn rg_replay_destroy(replay: *mut *mut rg_replay);
}
///A ray: the points origin + t \* direction with t\_min \<= t \<= t\_max. Distances t are in units of direction's length.
#[repr(C)]
#[derive(Debug, Default, Copy, Clone)]
pub struct rg_ray {
    pub origin: [f64; 3usize],
    pub direction: [f64; 3usize],
    pub t_min: f64,
    pub t_max: f64,
    pub mask: u32,
    pub reserved: u32,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_ray"][::core::mem::size_of::<rg_ray>() - 72usize];
    ["Alignment of rg_ray"][::core::mem::align_of::<rg_ray>() - 8usize];
    [
        "Offset of field: rg_ray::origin",
    ][::core::mem::offset_of!(rg_ray, origin) - 0usize];
    [
        "Offset of field: rg_ray::direction",
    ][::core::mem::offset_of!(rg_ray, direction) - 24usize];
    ["Offset of field: rg_ray::t_min"][::core::mem::offset_of!(rg_ray, t_min) - 48usize];
    ["Offset of field: rg_ray::t_max"][::core::mem::offset_of!(rg_ray, t_max) - 56usize];
    ["Offset of field: rg_ray::mask"][::core::mem::offset_of!(rg_ray, mask) - 64usize];
    [
        "Offset of field: rg_ray::reserved",
    ][::core::mem::offset_of!(rg_ray, reserved) - 68usize];
};
unsafe extern "C" {
    ///The ray from `origin` along `direction`: t from 0 to infinity, all mask bits set.
    pub fn rg_ray_from(origin: *const f64, direction: *const f64) -> rg_ray;
}
/**The closest hit of a ray. For a miss: object RG\_NO\_OBJECT, t +infinity (NaN for an invalid ray), primitive
RG\_NO\_PRIMITIVE, all else 0.*/
#[repr(C)]
#[derive(Debug, Default, Copy, Clone)]
pub struct rg_hit {
    pub t: f64,
    pub object: rg_object,
    pub position: [f64; 3usize],
    pub normal: [f32; 3usize],
    pub offset: f32,
    pub u: f32,
    pub v: f32,
    pub primitive: u32,
    pub reserved: u32,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_hit"][::core::mem::size_of::<rg_hit>() - 72usize];
    ["Alignment of rg_hit"][::core::mem::align_of::<rg_hit>() - 8usize];
    ["Offset of field: rg_hit::t"][::core::mem::offset_of!(rg_hit, t) - 0usize];
    [
        "Offset of field: rg_hit::object",
    ][::core::mem::offset_of!(rg_hit, object) - 8usize];
    [
        "Offset of field: rg_hit::position",
    ][::core::mem::offset_of!(rg_hit, position) - 16usize];
    [
        "Offset of field: rg_hit::normal",
    ][::core::mem::offset_of!(rg_hit, normal) - 40usize];
    [
        "Offset of field: rg_hit::offset",
    ][::core::mem::offset_of!(rg_hit, offset) - 52usize];
    ["Offset of field: rg_hit::u"][::core::mem::offset_of!(rg_hit, u) - 56usize];
    ["Offset of field: rg_hit::v"][::core::mem::offset_of!(rg_hit, v) - 60usize];
    [
        "Offset of field: rg_hit::primitive",
    ][::core::mem::offset_of!(rg_hit, primitive) - 64usize];
    [
        "Offset of field: rg_hit::reserved",
    ][::core::mem::offset_of!(rg_hit, reserved) - 68usize];
};
unsafe extern "C" {
    /**Closest hits of `count` rays. hits\[i\] belongs to rays\[i\].
Errors: RG\_INVALID\_ARGUMENT (a NULL pointer with count \> 0), RG\_LIMIT\_EXCEEDED (count \> 2^48), RG\_CALLBACK\_FAILED
(a user-defined shape failed: the rays concerned have t NaN, all others are complete).*/
    pub fn rg_scene_trace(
        scene: *mut rg_scene,
        rays: *const rg_ray,
        hits: *mut rg_hit,
        count: u64,
    ) -> rg_result;
}
unsafe extern "C" {
    ///Whether each ray hits anything: occluded\[i\] = 1 or 0; 0 for an invalid ray. Errors: as rg\_scene\_trace.
    pub fn rg_scene_occluded(
        scene: *mut rg_scene,
        rays: *const rg_ray,
        occluded: *mut u8,
        count: u64,
    ) -> rg_result;
}
///Rays where they lie. Zero it, set the size, then what is given.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_ray_views {
    pub size: usize,
    pub origin: rg_input3,
    pub direction: rg_input3,
    pub t_min: rg_input,
    pub t_max: rg_input,
    pub mask: rg_input,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_ray_views"][::core::mem::size_of::<rg_ray_views>() - 160usize];
    ["Alignment of rg_ray_views"][::core::mem::align_of::<rg_ray_views>() - 8usize];
    [
        "Offset of field: rg_ray_views::size",
    ][::core::mem::offset_of!(rg_ray_views, size) - 0usize];
    [
        "Offset of field: rg_ray_views::origin",
    ][::core::mem::offset_of!(rg_ray_views, origin) - 8usize];
    [
        "Offset of field: rg_ray_views::direction",
    ][::core::mem::offset_of!(rg_ray_views, direction) - 48usize];
    [
        "Offset of field: rg_ray_views::t_min",
    ][::core::mem::offset_of!(rg_ray_views, t_min) - 88usize];
    [
        "Offset of field: rg_ray_views::t_max",
    ][::core::mem::offset_of!(rg_ray_views, t_max) - 112usize];
    [
        "Offset of field: rg_ray_views::mask",
    ][::core::mem::offset_of!(rg_ray_views, mask) - 136usize];
};
impl Default for rg_ray_views {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
///Hits where they are wanted. Zero it, set the size, then what is wanted; the rest is not computed.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_hit_views {
    pub size: usize,
    pub t: rg_output,
    pub object: rg_output,
    pub primitive: rg_output,
    pub normal: rg_output3,
    pub u: rg_output,
    pub v: rg_output,
    pub position: rg_output3,
    pub offset: rg_output,
    pub cells: rg_output,
    pub tests: rg_output,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_hit_views"][::core::mem::size_of::<rg_hit_views>() - 280usize];
    ["Alignment of rg_hit_views"][::core::mem::align_of::<rg_hit_views>() - 8usize];
    [
        "Offset of field: rg_hit_views::size",
    ][::core::mem::offset_of!(rg_hit_views, size) - 0usize];
    [
        "Offset of field: rg_hit_views::t",
    ][::core::mem::offset_of!(rg_hit_views, t) - 8usize];
    [
        "Offset of field: rg_hit_views::object",
    ][::core::mem::offset_of!(rg_hit_views, object) - 32usize];
    [
        "Offset of field: rg_hit_views::primitive",
    ][::core::mem::offset_of!(rg_hit_views, primitive) - 56usize];
    [
        "Offset of field: rg_hit_views::normal",
    ][::core::mem::offset_of!(rg_hit_views, normal) - 80usize];
    [
        "Offset of field: rg_hit_views::u",
    ][::core::mem::offset_of!(rg_hit_views, u) - 120usize];
    [
        "Offset of field: rg_hit_views::v",
    ][::core::mem::offset_of!(rg_hit_views, v) - 144usize];
    [
        "Offset of field: rg_hit_views::position",
    ][::core::mem::offset_of!(rg_hit_views, position) - 168usize];
    [
        "Offset of field: rg_hit_views::offset",
    ][::core::mem::offset_of!(rg_hit_views, offset) - 208usize];
    [
        "Offset of field: rg_hit_views::cells",
    ][::core::mem::offset_of!(rg_hit_views, cells) - 232usize];
    [
        "Offset of field: rg_hit_views::tests",
    ][::core::mem::offset_of!(rg_hit_views, tests) - 256usize];
};
impl Default for rg_hit_views {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
///Which sides of surfaces rays hit.
pub type rg_cull = i32;
pub const RG_CULL_NONE: i32 = 0;
pub const RG_CULL_BACK: i32 = 1;
pub const RG_CULL_FRONT: i32 = 2;
/**Decides on a possible hit of ray `index`: 1 accepts, 0 lets the ray pass through this surface, negative fails the
ray: the trace then returns RG\_CALLBACK\_FAILED. Called for candidates in any order, not only for the closest, and
possibly more than once for the same one; from several threads at once.*/
pub type rg_filter = ::core::option::Option<
    unsafe extern "C" fn(
        user: *mut ::core::ffi::c_void,
        index: u64,
        candidate: *const rg_hit,
    ) -> i32,
>;
///Whether rays that follow one another in a call go nearly the same way. No answer depends on it, only time.
pub type rg_coherence = i32;
pub const RG_COHERENCE_UNKNOWN: i32 = 0;
pub const RG_COHERENCE_LOW: i32 = 1;
pub const RG_COHERENCE_HIGH: i32 = 2;
///How to trace. NULL in place of it means all defaults.
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct rg_trace_config {
    pub size: usize,
    pub cull: rg_cull,
    pub coherence: rg_coherence,
    pub filter: rg_filter,
    pub filter_user: *mut ::core::ffi::c_void,
    pub invalid: *mut u64,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
#[cfg(target_pointer_width = "64")]
const _: () = {
    ["Size of rg_trace_config"][::core::mem::size_of::<rg_trace_config>() - 40usize];
    [
        "Alignment of rg_trace_config",
    ][::core::mem::align_of::<rg_trace_config>() - 8usize];
    [
        "Offset of field: rg_trace_config::size",
    ][::core::mem::offset_of!(rg_trace_config, size) - 0usize];
    [
        "Offset of field: rg_trace_config::cull",
    ][::core::mem::offset_of!(rg_trace_config, cull) - 8usize];
    [
        "Offset of field: rg_trace_config::coherence",
    ][::core::mem::offset_of!(rg_trace_config, coherence) - 12usize];
    [
        "Offset of field: rg_trace_config::filter",
    ][::core::mem::offset_of!(rg_trace_config, filter) - 16usize];
    [
        "Offset of field: rg_trace_config::filter_user",
    ][::core::mem::offset_of!(rg_trace_config, filter_user) - 24usize];
    [
        "Offset of field: rg_trace_config::invalid",
    ][::core::mem::offset_of!(rg_trace_config, invalid) - 32usize];
};
impl Default for rg_trace_config {
    fn default() -> Self {
        let mut s = ::core::mem::MaybeUninit::<Self>::uninit();
        unsafe {
            ::core::ptr::write_bytes(s.as_mut_ptr(), 0, 1);
            s.assume_init()
        }
    }
}
unsafe extern "C" {
    ///Fills `config` with the defaults. RG\_INVALID\_ARGUMENT: config is NULL or the size unknown.
    pub fn rg_trace_config_default(
        config: *mut rg_trace_config,
        size: usize,
    ) -> rg_result;
}
unsafe extern "C" {
    ///Closest hits by views. Errors: as rg\_scene\_trace; RG\_INVALID\_ARGUMENT for a view of a type that it can't have.
    pub fn rg_scene_trace_views(
        scene: *mut rg_scene,
        config: *const rg_trace_config,
        rays: *const rg_ray_views,
        hits: *const rg_hit_views,
        count: u64,
    ) -> rg_result;
}
unsafe extern "C" {
    ///Any hit by views: `occluded`, RG\_U8, receives 1 or 0; 0 for an invalid ray. Errors: as rg\_scene\_trace\_views.
    pub fn rg_scene_occluded_views(
        scene: *mut rg_scene,
        config: *const rg_trace_config,
        rays: *const rg_ray_views,
        occluded: *const rg_output,
        count: u64,
    ) -> rg_result;
}
