// Layout of everything core reads or writes in main memory. Little-endian, no pointers; core/SPEC.md is the text form.
// Memory: described, not owned. Threads: read-only during a frame. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

inline constexpr std::uint32_t kLineBytes = 128;  ///< alignment of every section, block and tile in main memory

// --- Scene image ------------------------------------------------------------------------------------------------

inline constexpr std::uint32_t kImageMagic = 0x49524447;  ///< "GDRI" as bytes
inline constexpr std::uint32_t kImageVersion = 2;     ///< the only one that is read; core/README.md, "Versions"
inline constexpr std::uint32_t kMaxSectionCount = 32;  ///< entries of a section table

/// How a triangle is stored in the kTriangles section. Fixed at build time; a frame must match what is stored.
enum class TriangleFormat : unsigned {
  kVertices = 1,    ///< VertexTriangle: `standard`, `exact`, `fast`
  kProjection = 2,  ///< ProjectionTriangle: `paper`
  kLattice = 3,     ///< LatticeTriangle: `compact`
};

/// What a section of an image holds.
enum class SectionKind : unsigned {
  // The grid: all four or none.
  kGrid = 1,        ///< one GridRecord
  kMacroTable = 2,  ///< MacroTableEntry[ceil(macro_cell_count / 32)]
  kCellBlocks = 3,  ///< cell blocks of cell_block_bytes each; block 0 is the empty one (all zero)
  kTriangles = 4,   ///< triangle records, grouped by cell, in the order of the cells in the blocks
  // Effects (base/effect_records.h): every section that the EffectsRecord counts, or none at all.
  kEffects = 5,          ///< one EffectsRecord
  kMaterials = 6,        ///< MaterialRecord[]
  kLights = 7,           ///< LightRecord[]
  kSurfaces = 8,         ///< SurfaceRecord[triangle_count]
  kNormals = 9,          ///< NormalRecord[]
  kEnvironmentMap = 10,  ///< EnvironmentBlock[]
  // The wide tree (base/tree_records.h): all three or none. Images with effects or without a grid have it.
  kTree = 11,           ///< one TreeRecord
  kTreeNodes = 12,      ///< TreeNode[node_count]
  kTreeTriangles = 13,  ///< triangle records, in the order of the leaves
  kEnd                   ///< kinds from here on are unknown, and skipped
};

/// First bytes of a scene image. 64 bytes, 128-byte aligned.
struct ImageHeader {
  std::uint32_t magic;             ///< kImageMagic
  std::uint32_t version;           ///< kImageVersion
  std::uint64_t image_bytes;       ///< whole image, a multiple of kLineBytes
  std::uint64_t check_value;       ///< of the whole image with this field taken as 0; see check_value.h
  std::uint32_t section_count;     ///< 1..kMaxSectionCount
  std::uint32_t section_table_offset_bytes;  ///< SectionEntry[section_count]
  std::uint32_t triangle_count;    ///< input triangles after fanning, dropped ones included
  std::uint32_t vertex_count;      ///< input vertices
  std::uint32_t dropped_triangle_count;  ///< zero-area triangles, in no cell
  std::uint32_t reserved[5];
};
static_assert(sizeof(ImageHeader) == 64);

/// One section: its place and contents. Readers skip unknown kinds.
struct SectionEntry {
  std::uint32_t kind;              ///< SectionKind
  std::uint32_t element_bytes;     ///< of one element
  std::uint64_t offset_bytes;      ///< from the start of the image, a multiple of kLineBytes
  std::uint64_t element_count;     ///< how many there are
  std::uint64_t section_bytes;     ///< element_bytes * element_count, or more where padded
};
static_assert(sizeof(SectionEntry) == 32);

/// Within these ranges no quantity of the traversal overflows and no scale is subnormal. A mesh, an image or a frame
/// beyond them is rejected.
inline constexpr float kCoordinateLimit = 0x1p120f;       ///< |vertex|, |eye|
inline constexpr float kLeastCellsPerUnit = 0x1p-122f;    ///< one cell across the widest mesh has more
inline constexpr float kGreatestCellsPerUnit = 0x1p100f;  ///< smaller meshes get fewer cells
inline constexpr double kCellSpaceLimit = 0x1p120;        ///< |eye|, in cells
inline constexpr double kCellDirectionLimit = 0x1p124;    ///< |direction|, in cells

/// Where stored vertices can lie: origin + step * k, k whole, 0..65535 on each axis. Every such value is a float: step
/// is a power of two, origin a multiple of it, and no value is beyond 2^24 steps.
struct Lattice {
  float origin[3];                 ///< place 0 of each axis
  float step;                      ///< kLeastLatticeStep or more
};
inline constexpr float kLeastLatticeStep = 0x1p-126f;     ///< the least normal float
inline constexpr std::uint32_t kLatticePlaces = 65536;    ///< along each axis
inline constexpr float kMostStepsFromZero = 0x1p24f - 0x1p17f;  ///< |vertex| / step; |origin| / step: one more

/// The grid. Cell (x, y, z) covers, in cell space, the closed box [x, x+1] x [y, y+1] x [z, z+1]; cell space is the
/// exact map p -> (p - minimum) * cells_per_unit of world space, taken with real numbers.
struct GridRecord {
  float minimum[3];                ///< world position of cell space's origin
  float cells_per_unit[3];         ///< [kLeastCellsPerUnit, kGreatestCellsPerUnit]
  std::uint32_t cell_count[3];     ///< 1..kMaxCellsPerAxis
  std::uint32_t macro_cell_count[3];       ///< ceil(cell_count / macro_width)
  std::uint32_t macro_width;       ///< m, cells along a macrocell's edge, 1..kMaxMacroWidth
  std::uint32_t cell_block_bytes;  ///< cell_block_bytes_of(triangle_format, m)
  std::uint32_t cell_block_count;  ///< non-empty macrocells + 1
  std::uint32_t triangle_format;   ///< TriangleFormat
  std::uint32_t triangle_bytes;    ///< record size, triangle_bytes_of(triangle_format)
  std::uint32_t reference_count;   ///< triangle records in the image
  float bounds_minimum[3];         ///< tight bounds of the kept triangles, world space
  float bounds_maximum[3];         ///< the other corner
  float lambda;                    ///< Eq. (1) of the paper
  Lattice lattice;                 ///< of kLattice; all zero in other formats
  std::uint32_t reserved[3];
};
static_assert(sizeof(GridRecord) == 128);

inline constexpr std::uint32_t kMaxCellsPerAxis = 2048;  ///< of a grid
inline constexpr std::uint32_t kMaxMacroWidth = 8;       ///< of a macrocell, in cells

/// 32 macrocells, x fastest, then y, then z. Macrocell i is bit i % 32 of entry i / 32. A set bit means non-empty; its
/// cell block is first_block + (set bits below it).
struct MacroTableEntry {
  std::uint32_t occupied;          ///< bit i: macrocell holds at least one reference
  std::uint32_t first_block;       ///< block index of the entry's first non-empty macrocell
};
static_assert(sizeof(MacroTableEntry) == 8);

/// One cell inside a cell block. A block always has m^3 cells, x fastest, then y, then z. In every block but the empty
/// one first_triangle keeps counting, also through empty cells: a block's triangles are contiguous.
struct CellRecord {
  std::uint32_t first_triangle;    ///< index into kTriangles
  std::uint32_t triangle_count;    ///< 0: an empty cell
};
static_assert(sizeof(CellRecord) == 8);

/// A cell in half the bytes, for lattice triangles: a cell ends where the next one of its block begins. A block has m^3
/// + 1 of these; the last one marks the end of the last cell.
struct CellBound {
  std::uint32_t first_triangle;    ///< index into kTriangles
};
static_assert(sizeof(CellBound) == 4);

/// A triangle by its input vertices (bit for bit).
struct VertexTriangle {
  float v[3][3];                   ///< corner, axis
  std::uint32_t reserved[2];
  std::uint32_t triangle_id;       ///< index in the input's order after fanning, dropped ones counted
};
static_assert(sizeof(VertexTriangle) == 48);

/// A triangle by its precomputed projection along axis_k (paper, section 4.1; Wald 2004, section 7.1.2).
/// Plane: p_k = n_d - n_u p_u - n_v p_v; u = k+1, v = k+2 (mod 3).
/// Barycentric: beta = b_u p_u + b_v p_v + b_d, gamma = c_u p_u + c_v p_v + c_d.
struct ProjectionTriangle {
  float n_u, n_v, n_d;             ///< of the plane
  float b_u, b_v, b_d;             ///< of beta
  float c_u, c_v, c_d;             ///< of gamma
  std::uint32_t axis_k;            ///< 0, 1, 2
  std::uint32_t reserved;
  std::uint32_t triangle_id;       ///< as of VertexTriangle
};
static_assert(sizeof(ProjectionTriangle) == 48);

/// A triangle by its vertices' places on the grid's lattice.
struct LatticeTriangle {
  std::uint16_t v[3][3];           ///< corner, axis
  std::uint16_t reserved;
  std::uint32_t triangle_id;       ///< as of VertexTriangle
};
static_assert(sizeof(LatticeTriangle) == 24);

/// The longest triangle record. Each ends with its triangle_id.
inline constexpr std::uint32_t kTriangleRecordBytes = 48;

// --- Frame ------------------------------------------------------------------------------------------------------

inline constexpr std::uint32_t kFrameMagic = 0x4d524647;  ///< "GFRM" as bytes
inline constexpr std::uint32_t kFrameVersion = 2;         ///< of FrameHead and of what follows it

/// How exactly hits are decided; core/README.md lists what each accuracy promises.
enum class Accuracy : unsigned {
  kStandard = 0,  ///< filtered edge signs with exact ones behind them, correctly rounded distance
  kPaper = 1,     ///< precomputed projection, reciprocals estimated, single precision; may leak
  kExact = 2,     ///< as kStandard, and of equal rounded distances the exact ones decide
  kFast = 3,      ///< signs and distances in single precision alone; may leak at edges, distances unbounded
  kCompact = 4,   ///< as kStandard, of triangles on the scene's lattice
};

/// What a pixel shows.
enum class Shading : unsigned {
  kNone = 0,    ///< hit or background
  kSimple = 1,  ///< facing ratio with the geometric normal
  kScene = 2,   ///< the effects of the scene, core/EFFECTS.md
};

/// Techniques of the traversal that a frame can switch off to measure their gain.
enum TechniqueBits : unsigned {
  kUseMailbox = 1u << 0,
  kUseCornerCulling = 1u << 1,
  kUseEmptySkip = 1u << 2,   ///< skip empty macrocells without a transfer
  kUseSubpackets = 1u << 3,  ///< cull by subpackets: those that a triangle cannot touch, those with nearer hits
};

/// Queue commands that stay free for a tile's own gets while finished tiles are written with the rest.
inline constexpr std::uint32_t kLeastInputCommands = 4;

/// Which engine traces the rays of a frame. sim/engine_work.h has a row for each.
enum class EngineId : unsigned {
  kGrid = 1,  ///< GridEngine
  kTree = 2,  ///< TileEngine
  kEnd
};
inline constexpr std::uint32_t kFirstOtherEngine = 1000;  ///< from here on, engines outside core

/// What a core needs to know of a frame, whatever engine traces its rays.
struct FrameHead {
  std::uint32_t magic;                 ///< kFrameMagic
  std::uint32_t version;               ///< kFrameVersion
  std::uint32_t width, height;         ///< pixels, 1..kMaxPictureWidth
  std::uint32_t tile_width;            ///< pixels, must equal the store layout's
  std::uint32_t tiles_x, tiles_y;      ///< ceil(width / tile_width), ceil(height / tile_width)
  std::uint32_t accuracy;              ///< Accuracy
  std::uint32_t shading;               ///< Shading
  std::uint32_t engine_id;             ///< EngineId: whose record follows
  std::uint32_t output_depth;          ///< tile buffers in rotation: 1 single, 2 double
  std::uint32_t fetch_depth;           ///< children of a tree's node under way at once; of kTree and kScene, else 0
  std::uint32_t background_rgba;       ///< 0xAABBGGRR
  float t_far;                         ///< a hit has 0 < t <= t_far; in units of the ray's direction
  std::uint32_t reserved0[2];

  // Pinhole camera: direction of the ray through the centre of pixel (x, y), y = 0 the top row, is
  // (corner + x * step_x) + y * step_y per component, each operation rounded to float.
  float eye[3];                        ///< origin of all rays, world space
  float corner[3];                     ///< direction through pixel (0, 0)
  float step_x[3];                     ///< one pixel to the right
  float step_y[3];                     ///< one pixel down

  std::uint64_t color_address;         ///< RGBA8, tile-major: tile i at i * tile_width^2 * 4, row-major inside
  std::uint64_t depth_address;         ///< float distance along the unit direction, kFloatMax where nothing; 0: off
  std::uint64_t id_address;            ///< triangle_id, kNoTriangle where nothing; 0: off
  std::uint64_t effects_address;       ///< EffectsRecord, of Shading::kScene; else 0
  std::uint64_t image_address;         ///< base of the offsets of effects and tree; of kTree and kScene, else 0
  std::uint64_t tree_address;          ///< TreeRecord, of EngineId::kTree and Shading::kScene; else 0
  std::uint32_t reserved1[8];
};
static_assert(sizeof(FrameHead) == 192);

/// Everything a core needs to know of a frame. Every core fetches it first. 128-byte aligned, at most three lines of
/// 128 bytes. @tparam EngineRecord  the engine's part, a multiple of 16 bytes.
template <class EngineRecord>
struct Frame : FrameHead {
  EngineRecord engine;  ///< what the engine alone reads
  static_assert(sizeof(FrameHead) + sizeof(EngineRecord) <= 3 * kLineBytes && sizeof(EngineRecord) % 16 == 0);
};

/// The grid's part of a frame.
struct GridFrame {
  GridRecord grid;                     ///< the scene image's
  std::uint64_t macro_table_address;   ///< sections of the scene image: MacroTableEntry[]
  std::uint64_t cell_blocks_address;   ///< blocks of cells
  std::uint64_t triangles_address;     ///< triangle records
  std::uint32_t macro_depth;           ///< cell blocks in flight or in use
  std::uint32_t triangle_depth;        ///< triangle buffers in flight or in use
  std::uint32_t techniques;            ///< TechniqueBits
  std::uint32_t reserved[7];
};
static_assert(sizeof(GridFrame) == 192);

using FrameRecord = Frame<GridFrame>;  ///< of the grid; in main memory every frame is as long

/// The tree's part of a frame: what it needs stands in the head.
struct TreeFrame {
  std::uint32_t reserved[4];
};
static_assert(sizeof(FrameRecord) == 384);

inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFu;  ///< id where a ray hits nothing
inline constexpr std::uint32_t kMaxPictureWidth = 16384;   ///< pixels, of width and height

}  // namespace gridiron
