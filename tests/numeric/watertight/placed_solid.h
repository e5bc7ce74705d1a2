// A solid in its place: its triangles in every form that is shot at, and what lies inside.
// Memory: std::vector, some 400 bytes a triangle. Threads: any, once built. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include "numeric/oracle.h"
#include "numeric/watertight/candidate_tree.h"
#include "numeric/watertight/shot.h"
#include "numeric/watertight/solids.h"
#include "support/test_mesh.h"

namespace gridiron::test {

/// What lies around a point: see PlacedSolid::look_around.
struct Surroundings {
  bool is_inside;
  std::uint32_t seen_triangle;  ///< one that is seen from there
};

/// Whether vertices stay where they are put, or are moved to the lattice that `compact` stores them on.
enum class Vertices : std::uint8_t { kAsPlaced, kOnLattice };

/// The records of a shot's candidates.
struct CandidateRecords {
  std::vector<std::uint32_t> ids;
  std::vector<watertight::VertexRecord> vertices;
  std::vector<watertight::ProjectionRecord> projections;
  std::vector<watertight::LatticeRecord> places;
};

class PlacedSolid {
 public:
  PlacedSolid(const Solid& solid, const Placement& placement, Vertices vertices = Vertices::kAsPlaced);
  PlacedSolid(const PlacedSolid&) = delete;
  PlacedSolid& operator=(const PlacedSolid&) = delete;

  [[nodiscard]] const TestMesh& mesh() const { return mesh_; }
  [[nodiscard]] const CandidateTree& tree() const { return tree_; }
  [[nodiscard]] const Oracle& oracle() const { return oracle_; }
  [[nodiscard]] const Vec3& low() const { return low_; }
  [[nodiscard]] const Vec3& high() const { return high_; }
  /// Largest extent of the bounds.
  [[nodiscard]] float width() const { return width_; }

  /// Decides whether a point is surely inside: on no triangle's plane within that triangle's bounds, and the surface
  /// winds around it a number of times other than 0. Then every ray from there hits a triangle (README.md has the
  /// proof). The winding number is that of a random ray that passes every edge at a distance that doubles are sure of:
  /// the signs with which the triangles it hits, by the oracle, are crossed.
  [[nodiscard]] Surroundings look_around(const Vec3& point, TestRandom& random) const;

  [[nodiscard]] bool is_on_lattice() const { return !places_.empty(); }

  /// Gives a shot its candidates. @param records  what holds them.
  void add_candidates(watertight::Shot& shot, CandidateRecords& records) const;

 private:
  [[nodiscard]] bool may_be_on_surface(const Vec3& point) const;
  void find_places();

  TestMesh mesh_;
  CandidateTree tree_;
  Oracle oracle_;
  std::vector<watertight::VertexRecord> vertices_;
  std::vector<watertight::ProjectionRecord> projections_;
  std::vector<watertight::LatticeRecord> places_;  // on a lattice alone
  Lattice lattice_{};
  Vec3 low_, high_;
  float width_;
};

}  // namespace gridiron::test
