//! Tests of files, selection and the panel, without a window.

mod panel;
mod selection;
mod strain;
mod tuning;
