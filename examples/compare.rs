//! Compares two pictures of the same view.
//!
//! `cargo run --release --example compare --features render -- A.png B.png` prints the mean difference of the
//! two pictures, and the mean difference in the worst tile, since a small defect hardly changes the mean of a
//! picture. It fails if either value exceeds the difference between two rasterisers.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use image::{ImageResult, RgbImage};

/// Width and height of a tile, pixels.
const TILE: u32 = 10;

/// Greatest tolerated mean difference of the pictures, of 255.
const PICTURE_LIMIT: f64 = 0.5;

/// Greatest tolerated mean difference in a tile, of 255.
const TILE_LIMIT: f64 = 10.0;

/// Exit code for pictures that cannot be compared.
const BAD_PICTURE: u8 = 2;

/// Compares two pictures.
#[derive(Debug, Parser)]
struct Arguments {
    /// The first picture.
    one: PathBuf,
    /// The second picture, of the same size.
    other: PathBuf,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let (one, other) = match (open(&arguments.one), open(&arguments.other)) {
        (Ok(one), Ok(other)) => (one, other),
        (Err(error), _) | (_, Err(error)) => {
            eprintln!("{error}");
            return ExitCode::from(BAD_PICTURE);
        }
    };
    if one.dimensions() != other.dimensions() {
        eprintln!("the pictures are {:?} and {:?} large", one.dimensions(), other.dimensions());
        return ExitCode::from(BAD_PICTURE);
    }
    let difference = Difference::between(&one, &other);
    let Difference { picture, tile, corner: (x, y) } = difference;
    println!(
        "mean difference {picture:.3} of 255, at most {PICTURE_LIMIT}; \
         worst tile {tile:.2} at ({x}, {y}), at most {TILE_LIMIT}"
    );
    if difference.tolerable() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn open(file: &Path) -> ImageResult<RgbImage> {
    image::open(file).map(|picture| picture.into_rgb8())
}

/// Difference of two pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Difference {
    /// Mean over the whole picture, of 255.
    picture: f64,
    /// Mean over the worst tile, of 255.
    tile: f64,
    /// Upper left corner of the worst tile, pixels.
    corner: (u32, u32),
}

impl Difference {
    /// The difference of pictures of the same size.
    fn between(one: &RgbImage, other: &RgbImage) -> Self {
        let (width, height) = one.dimensions();
        let corners = (0..height)
            .step_by(TILE as usize)
            .flat_map(|y| (0..width).step_by(TILE as usize).map(move |x| (x, y)));
        let tiles = corners.map(|(x, y)| {
            let right = (x + TILE).min(width);
            let bottom = (y + TILE).min(height);
            let pixels = (y..bottom).flat_map(|y| (x..right).map(move |x| (x, y)));
            let sum: f64 = pixels
                .map(|(x, y)| between_pixels(one.get_pixel(x, y).0, other.get_pixel(x, y).0))
                .sum();
            ((x, y), sum, f64::from((right - x) * (bottom - y)))
        });
        let whole = Self { picture: 0.0, tile: 0.0, corner: (0, 0) };
        let area = f64::from(width) * f64::from(height);
        tiles.fold(whole, |worst, (corner, sum, pixels)| {
            let picture = worst.picture + sum / area;
            if sum / pixels > worst.tile {
                Self { picture, tile: sum / pixels, corner }
            } else {
                Self { picture, ..worst }
            }
        })
    }

    fn tolerable(self) -> bool {
        self.picture <= PICTURE_LIMIT && self.tile <= TILE_LIMIT
    }
}

/// The mean difference of the channels of two pixels.
fn between_pixels(one: [u8; 3], other: [u8; 3]) -> f64 {
    let channels = one.iter().zip(other).map(|(&a, b)| f64::from(a.abs_diff(b)));
    channels.sum::<f64>() / 3.0
}
