//! The guide in `docs/guide`, whose snippets are compiled and run as tests.

#[doc = include_str!("../../../docs/guide/concepts.md")]
mod concepts {}

#[doc = include_str!("../../../docs/guide/frames.md")]
mod frames {}

#[doc = include_str!("../../../docs/guide/materials.md")]
mod materials {}

#[doc = include_str!("../../../docs/guide/anchors.md")]
mod anchors {}

#[doc = include_str!("../../../docs/guide/seams.md")]
mod seams {}

#[doc = include_str!("../../../docs/guide/skeletons.md")]
mod skeletons {}

#[doc = include_str!("../../../docs/guide/wind.md")]
mod wind {}

#[doc = include_str!("../../../docs/guide/pressure.md")]
mod pressure {}

#[doc = include_str!("../../../docs/guide/colliders.md")]
mod colliders {}

#[doc = include_str!("../../../docs/guide/caught.md")]
mod caught {}

#[doc = include_str!("../../../docs/guide/reading.md")]
mod reading {}

#[doc = include_str!("../../../docs/guide/levels.md")]
mod levels {}

#[doc = include_str!("../../../docs/guide/effort.md")]
mod effort {}

#[doc = include_str!("../../../docs/guide/determinism.md")]
mod determinism {}

#[cfg(feature = "serialize")]
#[doc = include_str!("../../../docs/guide/saving.md")]
mod saving {}

#[doc = include_str!("../../../docs/guide/floating-origin.md")]
mod floating_origin {}

#[doc = include_str!("../../../docs/guide/scale.md")]
mod scale {}

#[doc = include_str!("../../../docs/guide/performance.md")]
mod performance {}

#[doc = include_str!("../../../docs/guide/web.md")]
mod web {}

#[doc = include_str!("../../../docs/guide/troubleshooting.md")]
mod troubleshooting {}

#[doc = include_str!("../../../docs/guide/coming-from.md")]
mod coming_from {}

#[doc = include_str!("../../../docs/guide/migration.md")]
mod migration {}

#[cfg(feature = "render")]
#[doc = include_str!("../../../docs/guide/meshes.md")]
mod meshes {}
