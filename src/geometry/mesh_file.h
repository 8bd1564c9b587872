#pragma once
#include <filesystem>

#include "geometry/mesh_data.h"

namespace turbid {

/// How a mesh file is to be read; the defaults are Mitsuba's, but for flip_tex_coords, where formats differ.
struct MeshFileOptions {
  Transform to_world{};
  bool face_normals = false;     ///< drop the normals of the file and compute none: facets
  bool flip_tex_coords = false;  ///< v becomes 1 - v; Mitsuba's default is true for OBJ, false for PLY
};

/// Reads a Wavefront OBJ file: v, vt, vn, f with any number of corners (fanned) and negative indices; everything else
/// is ignored. Vertex normals are computed when the file has none, unless face_normals. Throws FileError.
MeshData load_obj(const std::filesystem::path& path, const MeshFileOptions& options = {.flip_tex_coords = true});

/// Reads a PLY file (ascii, binary of either byte order): x y z; nx ny nz; u v, s t or texture_u texture_v;
/// vertex_indices or vertex_index of any integer types with any number of corners (fanned); r g b (red green blue) and
/// Mitsuba's `name_0 ...` as attributes. Vertex normals are computed when the file has none, unless face_normals.
/// Throws FileError.
MeshData load_ply(const std::filesystem::path& path, const MeshFileOptions& options = {});

/// Reads mesh number `shape_index` (from 0) of a Mitsuba serialized file, version 3 or 4: a table of contents at the
/// end and, per mesh, zlib-compressed arrays of positions, normals, uvs and colours (the attribute `vertex_color`) in
/// single or double precision. A file may ask for facets as face_normals does; vertex normals are computed when it has
/// none. flip_tex_coords has no effect. Throws FileError.
MeshData load_serialized(const std::filesystem::path& path, int64_t shape_index, const MeshFileOptions& options = {});

/// What all readers do last: names the mesh, maps it to the world, drops or computes normals.
void finish_loaded_mesh(MeshData& mesh, const std::filesystem::path& path, const MeshFileOptions& options);

}  // namespace turbid
