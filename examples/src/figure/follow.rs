//! The viewer stays beside the figure.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::figure::walker::Walker;

/// Keeps the viewer at a place that is seen from the figure's feet, m.
pub fn follow(
    eye: Vec3,
) -> impl FnMut(Single<&Transform, Walking>, Query<&mut Transform, With<LodViewer>>) {
    move |figure, mut viewers| {
        for mut viewer in &mut viewers {
            viewer.translation = figure.translation * Vec3::new(1.0, 0.0, 1.0) + eye;
        }
    }
}

/// The figure, which is no viewer.
type Walking = (With<Walker>, Without<LodViewer>);
