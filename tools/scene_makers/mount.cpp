// The fractal mountain. SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "scene_makers/nff_text.h"
#include "scene_makers/procedural.h"

namespace gridiron::scene_makers {
namespace {

// A number from -1 to 1 that depends only on a place. Places are those of the finest grid, so that a larger size adds
// detail to the same mountain.
double noise(std::uint32_t column, std::uint32_t row) {
  std::uint64_t bits = std::uint64_t{column} << 32 | row;
  for (int round = 0; round < 3; ++round) {
    bits += 0x9E3779B97F4A7C15u;  // 2^64 over the golden ratio: odd, no pattern
    bits ^= bits >> 29;
    bits *= 0xD1342543DE82EF95u;
    bits ^= bits >> 32;
  }
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1.0;
}

// Heights over a square grid of 2^size cells a side: edges are halved repeatedly, middles moved by less and less.
class Heights {
 public:
  explicit Heights(std::uint32_t size) : width_((1u << size) + 1), heights_(std::size_t{width_} * width_) {
    constexpr double kFirstMove = 0.25;
    constexpr double kRoughness = 0.574349;  // 2^-0.8: of fractal dimension 2.2
    double move = kFirstMove;
    for (std::uint32_t step = width_ - 1; step > 1; step /= 2, move *= kRoughness) halve(step, move);
  }

  [[nodiscard]] double at(std::uint32_t column, std::uint32_t row) const {
    return heights_[std::size_t{row} * width_ + column];
  }

 private:
  double& at(std::uint32_t column, std::uint32_t row) { return heights_[std::size_t{row} * width_ + column]; }

  // The middle of the whole grid is lifted to form the top of the mountain.
  [[nodiscard]] double moved_by(std::uint32_t column, std::uint32_t row, double move) const {
    constexpr double kTop = 0.5;
    const std::uint32_t cells = width_ - 1, fine = (1u << kMostMountSize) / cells;
    const bool is_middle = 2 * column == cells && 2 * row == cells;
    return move * noise(column * fine, row * fine) + (is_middle ? kTop : 0.0);
  }

  void halve(std::uint32_t step, double move) {
    const std::uint32_t half = step / 2, last = width_ - 1;
    for (std::uint32_t row = 0; row <= last; row += step) {
      for (std::uint32_t column = half; column < last; column += step) {
        at(column, row) = 0.5 * (at(column - half, row) + at(column + half, row)) + moved_by(column, row, move);
      }
    }
    for (std::uint32_t row = half; row < last; row += step) {
      for (std::uint32_t column = 0; column <= last; column += step) {
        at(column, row) = 0.5 * (at(column, row - half) + at(column, row + half)) + moved_by(column, row, move);
      }
      for (std::uint32_t column = half; column < last; column += step) {
        const double sum =
            at(column - half, row) + at(column + half, row) + at(column, row - half) + at(column, row + half);
        at(column, row) = 0.25 * sum + moved_by(column, row, move);
      }
    }
  }

  std::uint32_t width_;
  std::vector<double> heights_;
};

}  // namespace

std::string make_mount(std::uint32_t size) {
  std::string text = begin_scene("mount", size, {-1.6, 1.6, 1.7}, {0, 0, 0}, {0, 0, 1}, 0.01);
  add_line(text, "l", {-100, -100, 100});

  // Four touching balls of glass: at the corners of a tetrahedron, one on top.
  add_line(text, "f", {1, 1, 1, 0.1, 0.1, 6.7, 0.9, 1.5});
  const Point middle = {-0.8, 0.8, 1};
  const double radius = 0.17, around = radius * std::sqrt(1.5);
  const double out = around * std::sqrt(8.0) / 3.0, half_root = 0.5 * std::sqrt(3.0);
  add_sphere(text, middle + Point{0, 0, around}, radius);
  add_sphere(text, middle + Point{out, 0, -around / 3.0}, radius);
  add_sphere(text, middle + Point{-0.5 * out, half_root * out, -around / 3.0}, radius);
  add_sphere(text, middle + Point{-0.5 * out, -half_root * out, -around / 3.0}, radius);

  add_line(text, "f", {0.5, 0.45, 0.35, 1, 0, 0, 0, 0});
  const Heights heights(size);
  const std::uint32_t cells = 1u << size;
  const auto place = [&](std::uint32_t column, std::uint32_t row) {
    const double scale = 2.0 / cells;
    return Point{column * scale - 1.0, row * scale - 1.0, heights.at(column, row)};
  };
  for (std::uint32_t row = 0; row < cells; ++row) {
    for (std::uint32_t column = 0; column < cells; ++column) {
      const Point a = place(column, row), b = place(column + 1, row);
      const Point c = place(column + 1, row + 1), d = place(column, row + 1);
      add_polygon(text, {a, b, c});
      add_polygon(text, {a, c, d});
    }
  }
  return text;
}

}  // namespace gridiron::scene_makers
