//! The plugin in an app with manual time: no window, no renderer, no GPU.

mod anchors;
mod any_order;
mod attachment;
mod broad_phase;
mod cloth_collision;
mod contacts;
mod determinism;
mod effort;
mod environment;
mod errors;
mod first_hour;
mod forces;
mod governor;
mod inertia;
mod levels;
mod lifecycle;
mod order;
mod rest;
mod substep;
mod thread_probe;
mod threads;
mod weights;
mod wind;
