//! Regions of the material that an artist has painted into an image.

use bevy_color::Color;
use bevy_image::{Image, TextureAccessError};
use bunting_solver::MaterialRegion;

use crate::render::painted_weights::ColorChannel;

/// The region of a cloth in which a channel of an image is bright, for [`ClothRegions`](crate::ClothRegions): its weight is the channel's
/// value as it is stored, from 0 to 1, at the texture coordinates of the cloth. Beyond 0 to 1 the image repeats. The values are copied; the
/// image may be unloaded.
///
/// # Errors
///
/// The image is not loaded, or has a format whose pixels Bevy cannot read, such as a compressed one.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_image::{Image, TextureAccessError};
///
/// /// Leather where the mask is red.
/// fn leather(mask: &Image) -> Result<ClothRegions, TextureAccessError> {
///     let red = image_region(mask, ColorChannel::Red)?;
///     Ok(ClothRegions::new([red.bending(300.0).stretch(5.0).density(4.0)]))
/// }
/// ```
pub fn image_region(
    image: &Image,
    channel: ColorChannel,
) -> Result<MaterialRegion, TextureAccessError> {
    let (columns, rows) = (image.width(), image.height());
    let value = |color: Color| match color {
        Color::LinearRgba(color) => [color.red, color.green, color.blue, color.alpha],
        other => {
            let color = other.to_srgba();
            [color.red, color.green, color.blue, color.alpha]
        }
    };
    let pixels = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let weights: Result<Vec<f32>, TextureAccessError> = pixels
        .map(|(column, row)| {
            let color = image.get_color_at(column, row)?;
            Ok(value(color)[channel as usize].clamp(0.0, 1.0))
        })
        .collect();
    Ok(MaterialRegion::image(columns, weights?))
}

#[cfg(test)]
mod tests {
    use bunting_solver::RegionShape;

    use super::*;

    #[test]
    fn a_channel_is_read_pixel_by_pixel_as_it_is_stored() {
        let mut image = Image::default();
        let texture = &mut image.texture_descriptor;
        (texture.size.width, texture.size.height) = (2, 1);
        let weights = |image: &Image, channel| match image_region(image, channel) {
            Ok(MaterialRegion { shape: RegionShape::Image { columns: 2, weights }, .. }) => weights,
            other => panic!("{other:?}"),
        };
        for format in [texture.format, texture.format.remove_srgb_suffix()] {
            image.texture_descriptor.format = format;
            image.data = Some(vec![0, 51, 0, 255, 0, 255, 102, 255]);
            let green = weights(&image, ColorChannel::Green);
            assert!((green[0] - 0.2).abs() < 1e-6 && green[1] == 1.0, "{format:?}: {green:?}");
            let blue = weights(&image, ColorChannel::Blue);
            assert!(blue[0] == 0.0 && (blue[1] - 0.4).abs() < 1e-6, "{format:?}: {blue:?}");
        }
        image.data = None;
        assert!(image_region(&image, ColorChannel::Red).is_err());
    }
}
