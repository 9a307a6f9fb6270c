//! Examples of bevy_bunting live beside this file, one folder each.
