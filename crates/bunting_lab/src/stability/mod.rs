//! The hard cases.
