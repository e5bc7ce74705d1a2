// Reference renderer: see the header. Headings are those of core/EFFECTS.md. SPDX-License-Identifier: Apache-2.0
#include "effects/reference/reference_renderer.h"

#include <atomic>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <thread>

namespace gridiron::test {
namespace {

using glm::dvec3;

constexpr double kStartShare = 1e-9;  // of sizes: what secondary rays pass over
constexpr double kAmbient = 0.5;

double fraction(double x) { return x - std::floor(x); }

std::uint32_t reversed_bits(std::uint32_t value, int count) {
  std::uint32_t result = 0;
  for (int i = 0; i < count; ++i) result |= ((value >> i) & 1u) << (count - 1 - i);
  return result;
}

double reversed(std::uint32_t s) { return reversed_bits(s, 32) / 4294967296.0; }

std::uint32_t mix(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  h ^= h >> 16;
  return h;
}

double largest(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// A ray that carries light towards the eye.
struct LightRay {
  ReferenceRay ray;
  std::uint32_t depth = 1, path = 1;
};

// A material, its shares scaled.
struct Shares {
  dvec3 color, diffuse;
  double specular, transmittance, shine, index;
  bool is_smooth, has_colors;
};

// Where a ray ends, and what is needed to shade there.
struct Surface {
  dvec3 point, d, v, g, s;  // d: unit
  bool enters = false;
  double least_length = 0.0;  // before which rays from here meet nothing
  std::uint32_t triangle = 0;
};

struct SampleResult {
  dvec3 light{0.0};
  std::uint32_t id = kReferenceNoTriangle;
  double depth = std::numeric_limits<double>::infinity();
};

// Renders pixels one after the other; one for each thread.
class Tracer {
 public:
  Tracer(const tool::SceneDescription& scene, const ReferenceGeometry& geometry, ReferenceSearch search)
      : scene_(scene), geometry_(geometry), search_(search) {
    for (const tool::SceneMaterial& material : scene.materials) {
      const double scale = std::max(1.0, double{material.kd} + material.ks + material.transmittance);
      const dvec3 color(material.color);
      shares_.push_back({color, material.kd / scale * color, material.ks / scale, material.transmittance / scale,
                         material.shine, material.index_of_refraction, material.smooth_normals,
                         material.vertex_colors});
    }
  }

  SampleResult sample(const ReferenceRay& eye_ray, std::uint32_t pixel, std::uint32_t sample) {
    pixel_ = pixel;
    sample_ = sample;
    ++counts_.primary;
    SampleResult result;
    result.light = light_along({eye_ray}, &result);
    return result;
  }

  [[nodiscard]] const ReferenceCounts& counts() const { return counts_; }

 private:
  // Paths. Light that comes from where the ray ends; the eye ray's id and depth go to `seen`.
  dvec3 light_along(const LightRay& ray, SampleResult* seen = nullptr) {
    const std::optional<ReferenceHit> hit = geometry_.nearest(ray.ray, search_);
    if (!hit) return scene_.environment ? environment(ray.ray.dir) : dvec3(scene_.background);
    if (seen != nullptr) {
      seen->id = hit->id;
      seen->depth = hit->t * glm::length(ray.ray.dir);
    }
    const Surface surface = surface_at(ray.ray, *hit);
    const Shares shares = shares_at(*hit);
    dvec3 light = from_lights(surface, shares, ray.path);
    if (scene_.ambient_occlusion) light += ambient(surface, shares, ray.path);
    if (ray.depth < scene_.recursion_depth) light += from_further_rays(ray, surface, shares);
    return light;
  }

  // The material of a hit, its diffuse share multiplied by the corners' colour.
  Shares shares_at(const ReferenceHit& hit) const {
    Shares shares = shares_[scene_.geometry.triangle_materials[hit.id]];
    if (!shares.has_colors) return shares;
    dvec3 color(0.0);
    for (int k = 0; k < 3; ++k) {
      color += hit.weights[k] * dvec3(scene_.geometry.colors[scene_.geometry.triangle_colors[hit.id][k]]);
    }
    shares.diffuse *= color;
    return shares;
  }

  // Surfaces.
  Surface surface_at(const ReferenceRay& ray, const ReferenceHit& hit) const {
    Surface surface;
    surface.triangle = hit.id;
    surface.point = ray.origin + hit.t * ray.dir;
    surface.d = glm::normalize(ray.dir);
    surface.v = -surface.d;
    const dvec3& normal = geometry_.normal(hit.id);
    surface.enters = glm::dot(surface.d, normal) < 0.0;
    surface.g = surface.enters ? normal : -normal;
    surface.s = surface.g;
    if (shares_[scene_.geometry.triangle_materials[hit.id]].is_smooth) {
      dvec3 m(0.0);
      for (int k = 0; k < 3; ++k) {
        m += hit.weights[k] * dvec3(scene_.geometry.normals[scene_.geometry.triangle_normals[hit.id][k]]);
      }
      if (glm::length(m) > 0.0) {
        m /= glm::length(m);
        if (!surface.enters) m = -m;
        if (glm::dot(m, surface.v) > 0.0) surface.s = m;
      }
    }
    double size = std::max(largest(surface.point), largest(ray.origin));
    for (int k = 0; k < 3; ++k) size = std::max(size, largest(geometry_.corner(hit.id, k)));
    surface.least_length = kStartShare * size;
    return surface;
  }

  ReferenceRay ray_from(const Surface& surface, const dvec3& dir) const {
    ReferenceRay ray{surface.point, dir};
    ray.least_t = surface.least_length / glm::length(dir);
    ray.skipped = surface.triangle;
    return ray;
  }

  // Lights.
  dvec3 from_light(const Surface& surface, const Shares& shares, const dvec3& position, const dvec3& color) {
    const dvec3 segment = position - surface.point;
    const double distance = glm::length(segment);
    if (!(distance > 0.0)) return dvec3(0.0);
    const dvec3 l = segment / distance;
    const double a = glm::dot(surface.s, l);
    if (a <= 0.0 || glm::dot(surface.g, l) <= 0.0) return dvec3(0.0);
    if (scene_.shadows) {
      ++counts_.shadow;
      ReferenceRay ray = ray_from(surface, segment);
      ray.most_t = 1.0;
      if (geometry_.is_any(ray, search_)) return dvec3(0.0);
    }
    dvec3 share = a * shares.diffuse;
    if (shares.specular > 0.0 && shares.shine > 0.0) {
      const dvec3 sum = l + surface.v;
      const double length = glm::length(sum);
      const double cosine = length > 0.0 ? std::max(0.0, glm::dot(surface.s, sum / length)) : 0.0;
      share += shares.specular * std::pow(cosine, shares.shine);
    }
    return color * share;
  }

  dvec3 from_lights(const Surface& surface, const Shares& shares, std::uint32_t path) {
    dvec3 light(0.0);
    for (const tool::PointLight& point : scene_.point_lights) {
      light += from_light(surface, shares, dvec3(point.position), dvec3(point.color));
    }
    auto index = static_cast<std::uint32_t>(scene_.point_lights.size());
    for (const tool::AreaLight& area : scene_.area_lights) {
      const ReferenceJitter jitter = reference_jitter(path, sample_, pixel_, 1 + index++);
      for (std::uint32_t s = 0; s < area.samples; ++s) {
        const double a = (s + jitter.j1) / area.samples;
        const double b = fraction(reversed(s) + jitter.j2);
        const dvec3 position = dvec3(area.corner) + a * dvec3(area.edge_u) + b * dvec3(area.edge_v);
        light += from_light(surface, shares, position, dvec3(area.color) / double(area.samples));
      }
    }
    return light;
  }

  // Ambient light.
  dvec3 ambient(const Surface& surface, const Shares& shares, std::uint32_t path) {
    const ReferenceJitter jitter = reference_jitter(path, sample_, pixel_, 0);
    const double x = surface.s.x, y = surface.s.y, z = surface.s.z;
    const double g = z >= 0.0 ? 1.0 : -1.0;
    const double q = -1.0 / (g + z);
    const double p = x * y * q;
    const dvec3 tangent_a(1.0 + g * x * x * q, g * p, -g * x);
    const dvec3 tangent_b(p, g + y * y * q, -y);
    const std::uint32_t samples = scene_.ambient_occlusion->samples;
    std::uint32_t open = 0;
    for (std::uint32_t s = 0; s < samples; ++s) {
      const double turn = 2.0 * std::numbers::pi * ((s + jitter.j1) / samples);
      const double u = fraction(reversed(s) + jitter.j2);
      const double r = std::sqrt(u);
      const dvec3 direction =
          r * std::cos(turn) * tangent_a + r * std::sin(turn) * tangent_b + std::sqrt(1.0 - u) * surface.s;
      if (glm::dot(direction, surface.g) <= 0.0) continue;
      ++counts_.occlusion;
      ReferenceRay ray = ray_from(surface, direction * double{scene_.ambient_occlusion->radius});
      ray.most_t = 1.0;
      open += geometry_.is_any(ray, search_) ? 0u : 1u;
    }
    return shares.diffuse * (kAmbient * open / samples);
  }

  // Reflection and refraction.
  dvec3 from_further_rays(const LightRay& from, const Surface& surface, const Shares& shares) {
    dvec3 light(0.0);
    double fresnel = 1.0;
    if (shares.transmittance > 0.0) {
      const double e = surface.enters ? 1.0 / shares.index : shares.index;
      // Refraction about a normal: none where all is reflected. Leaves Fresnel's share.
      const auto refract = [&](const dvec3& normal) -> std::optional<dvec3> {
        const double c = glm::dot(surface.v, normal);
        const double k = 1.0 - e * e * (1.0 - c * c);
        fresnel = 1.0;
        if (k < 0.0) return std::nullopt;
        const double f = std::sqrt(k);
        const double rs = (e * c - f) / (e * c + f);
        const double rp = (c - e * f) / (c + e * f);
        fresnel = (rs * rs + rp * rp) / 2.0;
        return e * surface.d + (e * c - f) * normal;
      };
      std::optional<dvec3> direction = refract(surface.s);
      if (direction && glm::dot(*direction, surface.g) >= 0.0) direction = refract(surface.g);
      const dvec3 share = shares.transmittance * (1.0 - fresnel) * shares.color;
      if (direction && share != dvec3(0.0)) {
        ++counts_.refracted;
        light += share * light_along({ray_from(surface, *direction), from.depth + 1, 2 * from.path + 1});
      }
    }
    const double share = shares.specular + shares.transmittance * fresnel;
    if (share > 0.0) {
      const auto reflect = [&](const dvec3& normal) {
        return surface.d - 2.0 * glm::dot(surface.d, normal) * normal;
      };
      dvec3 direction = reflect(surface.s);
      if (glm::dot(direction, surface.g) <= 0.0) direction = reflect(surface.g);
      ++counts_.reflected;
      light += share * light_along({ray_from(surface, direction), from.depth + 1, 2 * from.path});
    }
    return light;
  }

  // Environment.
  dvec3 environment(const dvec3& d) {
    ++counts_.environment;
    const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
    const int axis = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
    const int face = 2 * axis + (d[axis] < 0.0 ? 1 : 0);
    static const dvec3 kRight[6] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {1, 0, 0}};
    static const dvec3 kUp[6] = {{0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {0, 1, 0}};
    const double a = glm::dot(kRight[face], d) / std::abs(d[axis]);
    const double b = glm::dot(kUp[face], d) / std::abs(d[axis]);
    const std::uint32_t w = scene_.environment->width;
    const double column = std::clamp((a + 1.0) / 2.0 * w - 0.5, 0.0, w - 1.0);
    const double row = std::clamp((1.0 - b) / 2.0 * w - 0.5, 0.0, w - 1.0);
    const auto i = static_cast<std::uint32_t>(column);
    const auto j = static_cast<std::uint32_t>(row);
    const auto texel = [&](std::uint32_t at_column, std::uint32_t at_row) {
      const std::size_t index = std::size_t{std::min(at_row, w - 1)} * w + std::min(at_column, w - 1);
      return dvec3(scene_.environment->texels[static_cast<std::size_t>(face)][index]);
    };
    return glm::mix(glm::mix(texel(i, j), texel(i + 1, j), column - i),
                    glm::mix(texel(i, j + 1), texel(i + 1, j + 1), column - i), row - j);
  }

  const tool::SceneDescription& scene_;
  const ReferenceGeometry& geometry_;
  ReferenceSearch search_;
  std::vector<Shares> shares_;
  std::uint32_t pixel_ = 0, sample_ = 0;
  ReferenceCounts counts_;
};

double srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::uint32_t rounded(const dvec3& linear, ColorLevels levels) {
  std::uint32_t color = 0xFF000000u;
  for (int channel = 0; channel < 3; ++channel) {
    const double within = std::clamp(linear[channel], 0.0, 1.0);
    const double value = 255.0 * (levels == ColorLevels::kSrgb ? srgb(within) : within) + 0.5;
    color |= static_cast<std::uint32_t>(value) << (8 * channel);
  }
  return color;
}

}  // namespace

glm::vec3 ReferenceCamera::direction(float x, float y) const {
  glm::vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    const float along_row = x * step_x[axis];
    const float down = y * step_y[axis];
    const float sum = corner[axis] + along_row;
    result[axis] = sum + down;
  }
  return result;
}

ReferenceCamera reference_camera(const tool::SceneView& view, std::uint32_t width, std::uint32_t height) {
  const auto tangent = static_cast<float>(std::tan(0.5 * double{view.angle_degrees} * std::numbers::pi / 180.0));
  const dvec3 forward = glm::normalize(dvec3(view.at) - dvec3(view.from));
  const dvec3 right = glm::normalize(glm::cross(forward, dvec3(view.up)));
  const dvec3 up = glm::cross(right, forward);
  // The picture is as high as twice the tangent, one unit away; rays go through the middle of pixels.
  const double pixel = 2.0 * tangent / height;
  const double left = pixel * (0.5 - 0.5 * width);
  const double top = pixel * (0.5 * height - 0.5);
  return {view.from, glm::vec3(forward + left * right + top * up), glm::vec3(pixel * right), glm::vec3(-pixel * up)};
}

glm::vec2 reference_sample_offset(std::uint32_t s, std::uint32_t count) {
  if (count == 1) return {0.0f, 0.0f};
  static constexpr std::uint32_t kRows[4] = {1, 3, 0, 2};
  const std::uint32_t row = count == 4 ? kRows[s] : reversed_bits(s, 4);
  const auto n = static_cast<float>(count);
  return {(static_cast<float>(s) + 0.5f) / n - 0.5f, (static_cast<float>(row) + 0.5f) / n - 0.5f};
}

ReferenceJitter reference_jitter(std::uint32_t path, std::uint32_t sample, std::uint32_t pixel,
                                 std::uint32_t purpose) {
  const std::uint32_t seed = mix(mix(mix(path) + sample) + pixel);
  const std::uint32_t key = mix(seed + purpose * 0x9E3779B9u);
  return {(key >> 8) / 16777216.0, (mix(key + 1) >> 8) / 16777216.0};
}

ReferencePicture render_reference(const tool::SceneDescription& scene, std::uint32_t width, std::uint32_t height,
                                  const ReferenceOptions& options) {
  const ReferenceGeometry geometry(scene.geometry);
  const ReferenceCamera camera = reference_camera(scene.view, width, height);
  ReferencePicture picture;
  picture.region = options.region.value_or(ReferenceRegion{0, 0, width, height});
  const std::size_t pixels = std::size_t{picture.region.width} * picture.region.height;
  picture.linear.resize(pixels);
  picture.color.resize(pixels);
  picture.ids.resize(pixels);
  picture.depth.resize(pixels);

  std::atomic<std::uint32_t> next_row{0};
  const auto render_rows = [&](ReferenceCounts& counts) {
    Tracer tracer(scene, geometry, options.search);
    for (std::uint32_t row; (row = next_row++) < picture.region.height;) {
      const std::uint32_t y = picture.region.top + row;
      for (std::uint32_t x = picture.region.left; x < picture.region.left + picture.region.width; ++x) {
        const std::size_t index = picture.index(x, y);
        dvec3 sum(0.0);
        for (std::uint32_t s = 0; s < scene.samples_per_pixel; ++s) {
          const glm::vec2 offset = reference_sample_offset(s, scene.samples_per_pixel);
          const glm::vec3 dir = camera.direction(static_cast<float>(x) + offset.x, static_cast<float>(y) + offset.y);
          const SampleResult seen = tracer.sample({dvec3(camera.eye), dvec3(dir)}, y * width + x, s);
          sum += seen.light;
          if (s == 0) {
            picture.ids[index] = seen.id;
            picture.depth[index] = seen.depth;
          }
        }
        picture.linear[index] = sum / double(scene.samples_per_pixel);
        picture.color[index] = rounded(picture.linear[index], scene.levels);
      }
    }
    counts = tracer.counts();
  };
  std::vector<ReferenceCounts> counts(std::max(1u, options.threads));
  std::vector<std::thread> threads;
  for (ReferenceCounts& own : counts) threads.emplace_back([&render_rows, &own] { render_rows(own); });
  for (std::thread& thread : threads) thread.join();
  for (const ReferenceCounts& own : counts) {
    for (const auto& [name, count] : kReferenceCounts) picture.counts.*count += own.*count;
  }
  return picture;
}

}  // namespace gridiron::test
