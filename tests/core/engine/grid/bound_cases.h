// Inputs that come closest to the kernel's error bounds: see error_bounds_test.cpp for how they were found.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::test {

/// A ray next to an edge.
struct EdgeCase {
  float origin[3], a[3], b[3], dir[3];
};
/// Shares, here and below, are the largest errors of the cases as parts of their bounds, a little less than found.
inline constexpr double kEdgeShare = 0.15;  ///< of kEdgeErrorFactor's 17 e
/// The first two between the ends of the edge.
inline constexpr EdgeCase kEdgeCases[] = {
    {{-0x1.000016p-2f, -0x1.619c84p-8f, 0x1.fdc582p-17f},
     {-0x1.40002p+0f, 0x1.fb4808p-2f, -0x1.933afp-8f},
     {-0x1.ffff46p-3f, 0x1.fb0adcp-2f, -0x1.01934p+0f},
     {-0x1.6cf5c2p+0f, 0x1.6d72c8p+0f, -0x1.71759cp+0f}},
    {{0x1.d92f54p-3f, -0x1.67f728p-4f, 0x1.5bfa3p-7f},
     {-0x1.36c0cap-1f, -0x1.02ba58p-2f, 0x1.0a583ap-2f},
     {-0x1.b17ebap-4f, -0x1.815d4p-1f, 0x1.85b5f6p-1f},
     {-0x1.6a4a2ep-1f, -0x1.5a7cc6p+0f, 0x1.87a63ep+0f}},
    {{0x1.5d5636p-3f, 0x1.c2d70ep+0f, -0x1.d7ba4cp-15f},
     {0x1.66f644p-1f, -0x1.747c38p-4f, 0x1.0c494p-1f},
     {-0x1.355cdcp-2f, -0x1.a2e0b8p-2f, -0x1.ea41fcp-2f},
     {0x1.00e8c4p+0f, 0x1.45dfb2p-2f, 0x1.00cb88p+0f}},
    {{-0x1.c7b664p-1f, -0x1.fffd02p-1f, -0x1.b4ede4p-1f},
     {0x1.7d19cap+0f, -0x1.00007ep+0f, -0x1.b4edc2p-1f},
     {0x1.2f324ep+0f, 0x1.0271e4p-17f, -0x1.da76e6p+0f},
     {0x1.ef97c2p-9f, -0x1.b21daep-7f, 0x1.b21c0cp-7f}},
};

/// A packet of a picture, and the ray of it that matters.
struct PacketPlace {
  std::uint32_t width;        ///< pixels of the packet
  std::uint32_t left, top;    ///< its first pixel
  std::uint32_t column, row;  ///< of the ray in the packet
};
/// A packet of a picture, the eye at 0, and an edge in its sight.
struct PictureCase : PacketPlace {
  float corner[3], step_x[3], step_y[3];
  float a[3], b[3];
};
inline constexpr double kCornerShare = 0.09;  ///< of what kEdgeErrorFactor and kCornerErrorFactor come to
/// In the first one rounding moves rays by far more than 17 e of the edge alone would cover; and its ray hits.
inline constexpr PictureCase kCornerCases[] = {
    {{8, 32, 4064, 6, 7},
     {0x1.25c9fcp+10f, -0x1.8526e6p+7f, -0x1.0168b4p+12f},
     {0x1.e18ceep-2f, 0x1.5beacap-2f, -0x1.263fa2p-3f},
     {-0x1.2da13ep-2f, 0x1.70b854p-5f, 0x1.034586p+0f},
     {-0x1.7c0112p+3f, 0x1.bb65bap+1f, -0x1.0c2168p+1f},
     {-0x1.761d66p+3f, 0x1.43d65ap+1f, -0x1.a4d922p+0f}},
    {{8, 0, 256, 6, 0},
     {-0x1.f12e4cp-31f, 0x1.56a5bp+2f, -0x1.ef8e02p-35f},
     {0x1.7f87eep-33f, -0x1.96851ap-33f, -0x1.e518aep-31f},
     {-0x1.4d8732p-6f, -0x1.511bdp-30f, -0x1.4d83e8p-6f},
     {-0x1.0026dep-30f, 0x1.fffff6p-31f, 0x1.04a868p-30f},
     {0x1.080d76p-6f, -0x1.0c3516p-6f, -0x1.0f3ef8p-6f}},
    {{32, 256, 4064, 28, 20},
     {-0x1.a0507ap-24f, -0x1.e5d75ap+0f, -0x1.43dff2p-25f},
     {-0x1.ccef98p-3f, -0x1.a8664ep-27f, -0x1.ccef26p-3f},
     {-0x1.6bce5ap-39f, -0x1.f11108p-7f, -0x1.005882p-24f},
     {-0x1.05fde4p+1f, 0x1.07c992p+1f, 0x1.05abb4p+1f},
     {0x1.8c41d4p-29f, -0x1.001afp-23f, -0x1.fea518p-24f}},
};
inline constexpr double kSubpacketShare = 0.034;  ///< of kSubpacketErrorFactor's 68 e
inline constexpr PictureCase kSubpacketCases[] = {
    {{32, 4064, 8160, 31, 31},
     {0x1.00011ep+0f, 0x1.d7996ep-17f, 0x1.00007cp+0f},
     {0x1.5f3228p-13f, -0x1.5f3548p-13f, 0x1.95c332p-17f},
     {-0x1.e08cacp-23f, -0x1.01cf56p-13f, 0x1.971856p-25f},
     {0x1.c3506cp+1f, -0x1.7e2cf6p+1f, 0x1.daefb4p+0f},
     {0x1.7238fcp+1f, -0x1.d1bafp+1f, 0x1.205166p+1f}},
    {{32, 0, 8160, 31, 31},
     {-0x1.2031a2p-14f, -0x1.180e3cp+0f, 0x1.3f703ep-5f},
     {-0x1.04e7e8p-4f, 0x1.976e6p-11f, -0x1.1bb492p-4f},
     {0x1.f7748ap-15f, -0x1.00bd88p-13f, 0x1.1daae6p-21f},
     {-0x1.2ecd12p+1f, -0x1.7f3ce2p+2f, -0x1.ff225p+1f},
     {-0x1.ea42ep+1f, -0x1.f8550ep+1f, -0x1.463ce6p+2f}},
    {{32, 4064, 1024, 12, 31},
     {-0x1.62b532p-5f, -0x1.000026p+0f, -0x1.0936fap+0f},
     {-0x1.4a96b8p-22f, -0x1.02f94ap-12f, -0x1.049b6ep-12f},
     {-0x1.f8797ep-11f, -0x1.f37a4ap-15f, -0x1.00d642p-24f},
     {-0x1.f14d04p-1f, -0x1.7112fp+1f, -0x1.4c0ea2p+2f},
     {-0x1.90ae3ep+1f, -0x1.55c262p+2f, -0x1.baa548p+1f}},
    {{32, 256, 32, 8, 31},
     {0x1.0067cp+0f, 0x1.f3b15p-1f, 0x1.fffffep-1f},
     {0x1.e541dcp-9f, 0x1.116362p-8f, 0x1.009eeep-12f},
     {0x1.561c8p-6f, 0x1.3be4cep-8f, 0x1.46f23ep-6f},
     {0x1.049fecp+3f, 0x1.0f4bf4p+2f, 0x1.81cfa2p+2f},
     {0x1.d06a3ap+2f, 0x1.9bdcf8p+2f, 0x1.39f394p+2f}},
    {{32, 1024, 32, 31, 31},
     {0x1.357c4ap+0f, 0x1.72611ep-1f, -0x1.40a95p+0f},
     {0x1.f81f8ap-11f, -0x1.d67108p-11f, -0x1.f844f4p-11f},
     {0x1.80cf92p-7f, -0x1.555556p-6f, 0x1.339beep-12f},
     {0x1.a259fap+2f, -0x1.13dd46p+1f, -0x1.89f4eep+2f},
     {0x1.8df478p+2f, -0x1.0ff534p+2f, -0x1.dca8a2p+1f}},
    {{32, 0, 256, 31, 31},
     {-0x1.00001p+0f, 0x1p+0f, -0x1.1dded6p-3f},
     {0x1.0e1eb2p-5f, 0x1.4fd666p-5f, -0x1.00000ep-4f},
     {-0x1.e1e1ep-9f, 0x1.e1e23ep-9f, -0x1.eaf16p-9f},
     {-0x1.7ab2cap+1f, 0x1.45286ap+2f, -0x1.23f81p+2f},
     {-0x1.1279c4p+0f, 0x1.a8bf7p+2f, -0x1.9e205ep+2f}},
};
inline constexpr double kRoundingShare = 0.32;  ///< of the same, if all roundings went the wrong way
inline constexpr PictureCase kWorstSubpacketCase = {{32, 8160, 0, 22, 31},
                                                    {0.0f, 0.0f, 0.0f},
                                                    {0.0f, 0x1.5b1ad4p-13f, -0x1.c4d306p-25f},
                                                    {-0x1.681fc6p-5f, 0x1.390288p-21f, -0x1.68029p-5f},
                                                    {0.0f, 0.0f, 0x1.c28d3ap+0f},
                                                    {0x1.5075acp-2f, -0x1.4e5a54p-2f, 0x1.6e6fdp+0f}};
inline constexpr double kPlaceShare = 0.081;  ///< of a projection's margin
/// Corners of triangles on a ray.
inline constexpr PictureCase kPlaceCases[] = {
    {{32, 0, 8160, 27, 31},
     {0x1.4798e4p+4f, 0x1.8143fep-5f, 0x1.d3d78p-2f},
     {-0x1.123dd2p-14f, -0x1.9683e4p-15f, 0x1.b497cap-10f},
     {-0x1.d9202ep-13f, 0x1.15d93cp-8f, -0x1.0526fcp-8f},
     {},
     {}},
    {{32, 8160, 32, 31, 31},
     {-0x1.cb4ea6p-7f, -0x1.395388p+6f, 0x1.32941ap+7f},
     {0x1.471bf8p-32f, -0x1.65ecaep-6f, 0x1.b2be7ep-7f},
     {0x1.7f3dfp-4f, -0x1.55f2bp-6f, 0x1.7af4dcp-6f},
     {},
     {}},
    {{32, 8160, 8160, 31, 11},
     {-0x1.f7af3p+2f, -0x1.dddb76p+2f, 0x1.94743p+2f},
     {0x1.27153ap-7f, 0x1.ae61d6p-32f, 0x1.0beefep-7f},
     {0x1.b2727p-21f, 0x1.8c4072p-8f, 0x1.48a8a8p-20f},
     {},
     {}},
};

/// Slices of a grid, and the plane between two of them that matters.
struct SlicePlane {
  std::uint32_t slices, plane;
};
/// A ray through a grid along its first two axes, close to the first; it matters at a plane between slices.
struct MarchCase : SlicePlane {
  float origin[2], minimum[2], cells_per_unit[2], dir[2];
  float t = 1.0f;  ///< of a hit
};
inline constexpr double kMarchShare = 0.34;  ///< of a frustum's pad
/// The first three would be lost with 1 e (|o_k| + N_k).
inline constexpr MarchCase kMarchCases[] = {
    {{2048, 2048},
     {-0x1.fda44ep+0f, 0x1.1d59f2p+0f},
     {-0x1.919cdp-1f, 0x1.4117ccp-3f},
     {0x1.054ddap+1f, 0x1.ab479ap-2f},
     {0x1.fe0298p-2f, 0x1.7a54b2p+0f}},
    {{1, 1},
     {-0x1.077bb4p+7f, 0x1.e3e914p-1f},
     {-0x1.e61c82p+0f, 0x1.7e19ap-1f},
     {0x1.031bdp+1f, 0x1.dc764cp+2f},
     {0x1.6dbbbap+0f, 0x1.5b8cc8p-2f}},
    {{1, 1},
     {-0x1.03d3dcp+9f, 0x1.9b2e6ep-5f},
     {-0x1.75af8p+2f, 0x1.e75154p-1f},
     {0x1.19ac5cp+0f, 0x1.45ba4cp-1f},
     {0x1.1d5eeap-1f, 0x1.e6c6d2p-1f}},
    {{8, 7},
     {-0x1.09f846p+10f, 0x1.bd6bfep-10f},
     {0x1.c0e7fep-1f, -0x1.2b4fcp+0f},
     {0x1.01a8dep+0f, 0x1.0e650ap+0f},
     {0x1.00009ep+1f, 0x1.e80e82p-1f}},
    {{1, 1},
     {-0x1.11ef2cp+7f, -0x1.f560a6p-1f},
     {-0x1.9626p-2f, -0x1.735deap+0f},
     {0x1.fcf722p-1f, 0x1.375166p+1f},
     {0x1.0770aap-1f, 0x1.b91198p-4f}},
    {{2, 2},
     {-0x1.ea8548p+4f, -0x1.aef172p+1f},
     {-0x1.17cd12p+0f, -0x1.ff84aep+1f},
     {0x1.0402e6p+0f, 0x1.b15654p-1f},
     {0x1.fffa84p-2f, 0x1.38e7c8p-2f}},
};
inline constexpr double kReachShare = 0.16;  ///< of pad_k
inline constexpr MarchCase kReachCases[] = {
    {{2, 1},
     {-0x1.574c74p+7f, 0.5f},
     {-0x1.2701cp-2f, 0.0f},
     {0x1.fffcbap-1f, 1.0f},
     {0x1.0003e2p+0f, 0.0f},
     0x1.58b3bcp+7f},
};

/// A ray and a triangle.
struct DistanceCase {
  float origin[3], a[3], b[3], c[3], dir[3];
};
inline constexpr double kEstimateShare = 0.19;  ///< of kEstimateError
/// The first three would be too far off if 1 e were charged.
inline constexpr DistanceCase kEstimateCases[] = {
    {{-0x1.7139dp-6f, 0x1.e197fep+1f, 0x1.5e7fd2p+1f},
     {-0x1.3e7d66p-2f, 0x1.83d584p-1f, -0x1.06b4cap-2f},
     {0x1.b5a962p+2f, 0x1.4e1c5ep-2f, -0x1.44f972p-2f},
     {-0x1.7f889p-6f, -0x1.aa84ecp+0f, -0x1.55562p+1f},
     {0x1.2a3fp-2f, 0x1.2e6c1ep-2f, 0x1.41123p-2f}},
    {{0x1.73f0a4p+1f, -0x1.87d6bep-1f, 0x1.c31b5cp+0f},
     {0x1.000044p+0f, -0x1.e83da2p-5f, 0x1.15f8acp-2f},
     {-0x1.7e30bep-6f, 0x1.02821cp+0f, 0x1.492b7ep-9f},
     {0x1.0079aep+0f, -0x1.10ffc6p+0f, -0x1.f365e2p-2f},
     {-0x1.873012p+0f, 0x1.6a8c6cp-2f, -0x1.527adap+0f}},
    {{0x1.486b9p-1f, -0x1.e5ded4p+0f, -0x1.142ce4p+0f},
     {0x1.82f1p-9f, -0x1.0caaf2p+0f, -0x1.d0392ap-4f},
     {-0x1.00470ep+0f, -0x1.dafd9ap-1f, 0x1.d6d20ap-1f},
     {0x1.6cae24p-1f, 0x1.001268p+0f, -0x1.816fc6p-7f},
     {0x1.18cd2cp-1f, -0x1.9657f8p-2f, -0x1.5eec1ep-1f}},
    {{0x1.0fac02p-11f, -0x1.5bd326p+0f, 0x1.0f0fd6p-1f},
     {0x1.66bbbep-1f, 0x1.af73p-8f, -0x1.2f71dp+0f},
     {-0x1.3a39dep-2f, -0x1.d68d04p-8f, -0x1.26082cp+0f},
     {-0x1.90fc4ap-2f, -0x1.01666cp+0f, 0x1.6f9p-12f},
     {0x1.0025ccp-7f, 0x1.f26972p-8f, -0x1.0c6d82p-7f}},
    {{-0x1.582704p+0f, 0x1.505ae2p-11f, 0x1.b61baep-1f},
     {0x1.033442p+0f, -0x1.3ce102p-11f, -0x1.9011e4p-1f},
     {0x1.27dc06p+0f, -0x1.059818p+1f, -0x1.6a6aep-1f},
     {-0x1.f9a26p-1f, -0x1.e6a964p-3f, 0x1.0d5d2ap-1f},
     {0x1.9217fp+0f, -0x1.ee51a6p-12f, -0x1.d1df3ap-1f}},
};
inline constexpr double kQuotientShare = 0.15;  ///< of what kDistanceError comes to
/// The first three would round to the wrong float if 2^-52 were charged.
inline constexpr DistanceCase kQuotientCases[] = {
    {{-0x1.00a4aap-1f, 0x1.5d8b9ep+1f, -0x1.224162p+0f},
     {-0x1.09e13p-26f, 0x1.0057eep+0f, -0x1.a72f86p-6f},
     {0x1.cc3e98p-3f, -0x1.00dd1p+0f, 0x1.3fe456p+0f},
     {0x1.000044p+0f, 0x1.fffffep-1f, 0x1.0a5ap-21f},
     {-0x1.365d5ap-2f, -0x1.f4758ap-1f, 0x1.938f02p+1f}},
    {{0x1.5a69d2p-1f, 0x1.0a7efcp+1f, -0x1.504ea2p-1f},
     {0x1.8ac3aap-19f, -0x1.0019aep+0f, 0x1.de66b4p-31f},
     {0x1.1ba0cap-4f, 0x1.00bb8cp+0f, -0x1.00002ap+0f},
     {0x1.00fa8p+0f, 0x1.1d61c6p-16f, 0x1.00004ep+0f},
     {-0x1.298998p-4f, -0x1.5f304cp-1f, -0x1.0a3e52p+1f}},
    {{-0x1.a130a8p-1f, 0x1.deeffep+0f, -0x1.c2e328p-1f},
     {0x1.749a26p-28f, 0x1.00001ap+0f, 0x1.fee956p-34f},
     {0x1.000002p+0f, 0x1.10b9fcp-25f, 0x1p+0f},
     {-0x1.000042p+0f, 0x1.000406p+0f, 0x1.65d8bp-3f},
     {-0x1.59536ap-1f, 0x1.391c34p-3f, 0x1.7f05d2p-59f}},
    {{-0x1.076fa6p+0f, -0x1.090002p-45f, -0x1.ffe202p-38f},
     {-0x1.06634p+0f, 0x1.17feeep+0f, -0x1.0451dep+0f},
     {-0x1.0598b8p+0f, 0x1.0a25acp-31f, 0x1.e6p-46f},
     {0x1.fff01p-1f, 0x1.387cap-34f, 0x1.2ce808p-32f},
     {0x1.7c296cp-35f, 0x1.75d724p-47f, 0x1.7bd2acp-49f}},
};

}  // namespace gridiron::test
