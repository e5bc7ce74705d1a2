// Engine: an acceleration structure with its traversals, as render/ and shade/ see it. A layout of the local store
// names its engines, Layout::Engine for eye rays and Layout::RayEngine for all others; render/ and shade/ name none.
// The grid's record in a frame, and the rules of its frames, are in base/: setting a frame up and checking one need
// them too.
// Memory: its parts of the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/hits.h>
#include <gridiron/ray/ray_batch.h>

#include <concepts>
#include <cstdint>

namespace gridiron {

/// Bytes of a buffer that an engine of rays lends to shading. The longest record that shading gathers is a block of the
/// environment map, 768 bytes, and a get begins up to 16 bytes before it.
inline constexpr std::uint32_t kIdleBufferBytes = 784;

/// What an engine of eye rays brings. `store` is the LocalStore of a layout.
///
/// E::kId               EngineId of its frames.
/// E::Record            its part of a frame's record, behind the FrameHead: a multiple of 16 bytes, at most 192. A core
///                      finds it as store.frame.engine.
/// E::Store<Layout>     its memory for the whole frame, store.engine; begin() initialises it. for_each_region(visit)
///                      names its members.
/// E::EyeStore<Layout>  its memory while eye rays are traced, store.packet. With effects, shading overwrites it.
/// E::kTracesEyes<Layout>  whether there is code for eye rays; if not, they are traced like all other rays.
/// E::Core<L, Store, P>    the engine on one core: see EngineCore.
template <class E, class Layout>
concept Engine = requires {
  { E::kId } -> std::convertible_to<std::uint32_t>;
  typename E::Record;
  typename E::template Store<Layout>;
  typename E::template EyeStore<Layout>;
  { E::template kTracesEyes<Layout> } -> std::convertible_to<bool>;
};

/// What an engine of other rays brings, to layouts with effects: Layout::RayEngine.
///
/// E::Store              its memory for the whole frame, store.rays; begin() initialises it.
/// E::RayStore<Layout>   its memory while rays are traced, store.wave.rays, in the place of EyeStore: only one of the
///                       two is valid at a time. lend(count) gives up `count` separate 32-byte aligned buffers of
///                       kIdleBufferBytes, idle_buffer(0) and on, while no ray is traced.
/// E::kMaxDepth<Layout>  the greatest frame.fetch_depth: children of a node, or records for shading, under way
///                       at once, and buffers that it lends; at most kTriangleTagCount.
/// E::Core<L, Store, P>  the engine on one core:
///   begin()       as EngineCore's.
///   begin_rays()  before the first rays after eye rays were traced: discards what its memory held.
///   trace(question, jobs)  answers rays, batch by batch, and returns a Status.
///                 jobs.next(batch) adds up to kJobRays rays to a batch: origin, dir, t, id (no_hit()) and owner. It
///                 returns false if there are no more, and has added none then. jobs.ends_batch(), if there is one,
///                 says after it that the next rays are better traced apart.
///                 Directions have any length, and a component may be 0.
///                 A hit has 0 < t <= rays.t.
///                 jobs.finish(batch) takes each batch once, with owners as they were and ids answered. Origins,
///                 directions and t are not kept. With question.any_hit any hit will do; else the hit does not depend
///                 on the engine, except with kFast, where distances are floats and edges that
///                 floats leave open may count as hit.
///                 next and finish charge work of their own: call charge_to() after them.
template <class E, class Layout>
concept RayEngine = requires {
  typename E::Store;
  typename E::template RayStore<Layout>;
  { E::template kMaxDepth<Layout> } -> std::convertible_to<std::uint32_t>;
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
