// Engine: an acceleration structure with its traversals, as render/ and shade/ see it. A layout of the local store
// names its engine as Layout::Engine; render/ and shade/ name none. The grid's record in a frame, and the rules of its
// frames, are in base/: setting a frame up and checking one need them too.
// Memory: its parts of the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/hits.h>
#include <gridiron/ray/walk_rays.h>

#include <concepts>
#include <cstdint>

namespace gridiron {

/// Bytes of a buffer that an engine lends to shading. The longest record that shading gathers is a block of the
/// environment map, 768 bytes, and a get begins up to 16 bytes before it.
inline constexpr std::uint32_t kIdleBufferBytes = 784;

/// What an engine brings. `store` is the LocalStore of a layout.
///
/// E::kId               EngineId of its frames.
/// E::Record            its part of a frame's record, behind the FrameHead: a multiple of 16 bytes, at most 192. A core
///                      finds it as store.frame.engine.
/// E::Store<Layout>     its memory for the whole frame, store.engine; begin() initialises it. for_each_region(visit)
///                      names its members. With effects it has idle_buffer(slot), for slots below frame.walk_depth:
///                      separate 32-byte aligned buffers of kIdleBufferBytes, lent while no ray is traced. What was in
///                      them is lost.
/// E::EyeStore<Layout>  its memory while eye rays are traced, store.packet. With effects, shading overwrites it.
/// E::RayStore<Layout>  its memory while other rays are traced, store.wave.engine, in the place of EyeStore: only one
///                      of the two is valid at a time. May be void where kMaxRayDepth is 0.
/// E::kTracesEyes<Layout>  whether there is code for eye rays; if not, they are traced like all other rays.
/// E::kMaxRayDepth<Layout> the greatest frame.walk_depth: groups of other rays under way at once, at most
///                         kTriangleTagCount. 0: it traces eye rays alone, and has no Shading::kScene.
/// E::Core<L, Store, P>    the engine on one core: see EngineCore.
template <class E, class Layout>
concept Engine = requires {
  { E::kId } -> std::convertible_to<std::uint32_t>;
  typename E::Record;
  typename E::template Store<Layout>;
  typename E::template EyeStore<Layout>;
  typename E::template RayStore<Layout>;
  { E::template kTracesEyes<Layout> } -> std::convertible_to<bool>;
  { E::template kMaxRayDepth<Layout> } -> std::convertible_to<std::uint32_t>;
};

/// An engine on one core, made of its LocalStore and Transfers before the frame's record arrives. It transfers under
/// kSetupTag and the tags from kFirstMacroTag up to but not kFirstOutputTag. When it returns kOk none of its transfers
/// is pending; an error ends the frame, and transfers may be pending then.
///
/// begin()             once a frame, when the frame's head has been checked: checks the engine's part, initialises its
///                     memory and fetches what outlives tiles. It refuses accuracies and shadings that it does not
///                     support. Errors: kBadFrame, kUnsupportedFrame, kUnsupportedImage, of transfers.
/// begin_tile()        before a tile: discards all state that would make the tile depend on those before it. An engine
///                     whose caches outlive tiles repeats its cycles only if tiles are assigned to cores in advance.
/// trace_eyes(view, hits)  traces the eye rays of a tile: from frame.eye, in the direction of pixel (x + dx, y + dy) as
///                     FrameHead defines it, with every operation rounded as written there (ray/hits.h has it). A hit
///                     has 0 < t <= t_far. The nearest wins; of equal rounded distances the lowest id, or with kExact
///                     the one that exact arithmetic finds nearer. Every pixel of the tile that lies in the picture is
///                     written; others may be. hits.distance is given if the frame has a plane of distances, for the
///                     first sample only; hits.facing with Shading::kSimple only.
/// trace(question, jobs)   answers other rays, group by group, and returns a Status.
///                     jobs.next(rays, purpose) fills origin, dir, t, id (kNoTriangle) and owner of the first n lanes
///                     and returns n, at most kWalkRays; 0: no more. The other lanes are undefined. Directions have any
///                     length, and a component may be 0. A hit has 0 < t <= rays.t.
///                     jobs.finish(rays, n, purpose) takes each group once, in any order, with owner as it was and id
///                     answered. With question.any_hit any hit will do; else the hit does not depend on the engine,
///                     except with kFast, where single precision decides.
///                     next and finish charge work of their own: call charge_to() after them. The engine sets dir_max,
///                     which ray/intersect_rays.h reads.
/// The compiler checks begin, begin_tile and trace_eyes here, the rest where it is used.
template <class C>
concept EngineCore = requires(C core, const TileView& view, const Hits& hits) {
  { core.begin() } -> std::same_as<Status>;
  core.begin_tile();
  { core.trace_eyes(view, hits) } -> std::same_as<Status>;
};

/// Whether the engine of a layout has code for eye rays.
template <class Layout>
inline constexpr bool kTracesEyes = Layout::Engine::template kTracesEyes<Layout>;

}  // namespace gridiron
