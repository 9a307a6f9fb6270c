//! The plugin in an app with manual time: no window, no renderer, no GPU.

mod anchors;
mod any_order;
mod attachment;
mod bad_anchors;
mod broad_phase;
mod contacts;
mod determinism;
mod effort;
mod environment;
mod errors;
mod first_hour;
mod forces;
mod governor;
mod holds;
mod inertia;
mod levels;
mod lifecycle;
mod order;
mod reactions;
mod rest;
mod skeletons;
mod substep;
mod thread_probe;
mod threads;
mod weights;
mod wind;
