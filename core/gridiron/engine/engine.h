// Engine: an acceleration structure with its traversals, as render/ and shade/ see it. A layout of the local store
// names its engine as Layout::Engine; nothing else of core names one. Memory: its parts of the local store. Threads:
// one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/hits.h>
#include <gridiron/ray/walk_rays.h>

#include <concepts>
#include <cstdint>

namespace gridiron {

/// Bytes of a buffer that an engine lends.
inline constexpr std::uint32_t kIdleBufferBytes = 784;

/// What an engine brings. `store` is the LocalStore of a layout.
///
/// E::kId               EngineId of its frames.
/// E::Record            its part of a frame's record, behind the FrameHead; a core finds it as store.frame.engine.
/// E::Store<Layout>     its part of the local store for the whole frame: buffers, tables; store.engine.
///                      idle_buffer(slot) lends 32-byte aligned kIdleBufferBytes to whoever gathers records while no
///                      ray is traced, for slots below frame.walk_depth; for_each_region(visit) names its members.
/// E::EyeStore<Layout>  its part while eye rays are traced; store.packet. Shading overwrites it.
/// E::RayStore<Layout>  its part while other rays are traced, in the same place; store.wave.engine.
/// E::kTracesEyes<Layout>  whether there is code for eye rays; if not, they are traced like all other rays.
/// E::kMaxRayDepth<Layout> the most groups of other rays under way at once: frame.walk_depth is at most that; 0: it
///                         traces eye rays alone.
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

/// An engine on one core, made of its LocalStore and Transfers. It transfers under the tags from kFirstMacroTag up to
/// but not kFirstOutputTag, and kSetupTag; when it returns kOk none of them is pending. All errors end the frame.
///
/// begin()             once a frame, when the frame's record is there and its head is checked: checks the engine's part
///                     and fetches what outlives tiles. It refuses each accuracy and shading that it does not decide as
///                     Accuracy defines it. Errors: kBadFrame, kUnsupportedFrame, kUnsupportedImage, of transfers.
/// begin_tile()        before a tile: forgets whatever would make the tile depend on those before it. An engine whose
///                     caches outlive tiles needs a fixed assignment of tiles to cores to render a frame twice alike.
/// trace_eyes(view, hits)  traces the eye rays of a tile. Writes every pixel of the tile that lies in the picture, and
///                     may write others. The planes are 128-byte aligned.
/// trace(question, jobs)   answers other rays: jobs.next(rays, purpose) makes up to kWalkRays of them and returns how
///                     many, 0: no more; the engine sets dir_max, and leaves origin, dir and owner as they are.
///                     jobs.finish(rays, count, purpose) is given the answers: of these only id is read, kNoTriangle
///                     where nothing is hit. Which come first is the engine's choice; what they are is not.
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
