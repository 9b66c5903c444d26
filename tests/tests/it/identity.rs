//! Every strategy, number of threads, size of tile and size of image gives the same bits; so does
//! every way of cutting an image into tiles, which is what lets strategies differ at all.
//!
//! `broken_strategies` shows that `check` catches errors; these tests are the proof for the real
//! tracer, against images that no strategy computed.

use rayweave_contract::{Image, Plan, Rect, Rgb, Tile, Work};
use rayweave_core::{Precision, Scene};
use rayweave_tests::image::{self, difference, pixel_by_pixel};
use rayweave_tests::random_scene::random_scene;
use rayweave_tests::scenes::{self, PRECISIONS};
use std::num::{NonZeroU32, NonZeroUsize};

const THREADS: [usize; 6] = [1, 2, 3, 5, 8, 64];
const TILES: [u32; 4] = [1, 7, 32, 1000];
const SIZES: [(u32, u32); 5] = [(1, 1), (1, 500), (500, 1), (7, 3), (97, 61)];
/// A colour that no scene here has, so that a pixel that is left out shows it.
const SENTINEL: Rgb = [f32::NAN; 3];

/// The scene of this name, at an antialiasing low enough to render it hundreds of times.
fn scene(name: &str) -> Scene {
    let mut scene = scenes::named(name);
    scene.render.antialiasing = scene.render.antialiasing.min(1);
    scene
}

/// Catches a strategy that leaves out, swaps or tears pixels, or keeps something of the image
/// before, and work with a memory: one renderer renders all sizes, one after the other, and one
/// work is rendered by all strategies.
fn strategies_agree(name: &str, precision: Precision) {
    let scene = scene(name);
    let images = SIZES.map(|(width, height)| {
        let work = image::work(&scene, (width, height), precision);
        let right = pixel_by_pixel(&*work, width, height);
        (work, right)
    });
    for strategy in rayweave_registry::available() {
        for (threads, tile) in THREADS.iter().flat_map(|threads| TILES.map(|tile| (*threads, tile)))
        {
            let context = format!("{name}: {}, {threads} threads, tiles of {tile}", strategy.name);
            let plan = Plan {
                threads: NonZeroUsize::new(threads).expect("not 0"),
                tile: NonZeroU32::new(tile).expect("not 0"),
            };
            let mut renderer = strategy.prepare(plan).expect(&context);
            for (work, right) in &images {
                let mut found =
                    Image::filled(right.width(), right.height(), SENTINEL).expect("an image");
                renderer.render(&**work, &mut found).expect(&context);
                assert_eq!(difference(&found, right), None, "{context}");
            }
        }
    }
}

/// Catches a strategy that races or mixes up tiles while the pixels cost about the same.
#[test]
fn strategies_agree_on_the_report() {
    strategies_agree("lab", Precision::F32);
}

/// Catches the same in wide numbers.
#[test]
fn strategies_agree_on_the_room() {
    strategies_agree("room", Precision::F64);
}

/// Catches the same where one corner costs almost everything: threads end far apart, tiles finish
/// out of order.
#[test]
fn strategies_agree_on_the_imbalance() {
    strategies_agree("imbalance", Precision::F32);
}

/// Catches work that shares something between the pixels of a tile and gets another rounding from
/// it: at the tile's edge, in its first row, or for one size of tile.
#[test]
fn a_pixel_is_the_same_in_every_tile() {
    let mut scenes: Vec<_> = scenes::NAMES.map(scene).into();
    // Denser lattices than above, odd and even, and none.
    scenes.extend([(0, 3), (2, 7), (3, 11)].map(|(antialiasing, seed)| {
        let mut scene = random_scene(seed);
        scene.render.antialiasing = antialiasing;
        scene
    }));
    for (number, scene) in scenes.iter().enumerate() {
        for precision in PRECISIONS {
            for (width, height) in [(1, 1), (1, 50), (50, 1), (7, 3), (48, 31)] {
                let work = image::work(scene, (width, height), precision);
                let context = format!("scene {number} in {precision}, {width}x{height}");
                tilings_agree(&*work, width, height, &context);
            }
        }
    }
}

fn tilings_agree(work: &dyn Work, width: u32, height: u32, context: &str) {
    let right = pixel_by_pixel(work, width, height);
    let agrees = |how: &str, render: &dyn Fn(&mut Image)| {
        let mut found = Image::filled(width, height, SENTINEL).expect("an image");
        render(&mut found);
        assert_eq!(difference(&found, &right), None, "{context}, {how}");
    };
    agrees("by row", &|image| {
        let rows = image.pixels_mut().chunks_mut(width as usize).enumerate();
        rows.rev().for_each(|(y, row)| work.render(&mut Tile::row(0, y as u32, row)));
    });
    agrees("by half a row", &|image| {
        for (y, row) in (0..).zip(image.pixels_mut().chunks_mut(width as usize)) {
            let (left, rest) = row.split_at_mut(width as usize / 2);
            work.render(&mut Tile::row(width / 2, y, rest));
            work.render(&mut Tile::row(0, y, left));
        }
    });
    // From one pixel to the whole image.
    for side in [1, 2, 3, 5, 8, 16, 1000] {
        agrees(&format!("tiles of {side}"), &|image| {
            let tiles = image.tiles(NonZeroU32::new(side).expect("not 0"));
            tiles.into_iter().rev().for_each(|mut tile| work.render(&mut tile));
        });
    }
}

/// Catches tiles that overlap, leave something out or are named after another place: then two
/// strategies could agree on a wrong image.
#[test]
fn tiles_are_where_they_say() {
    struct Place;
    impl Work for Place {
        fn render(&self, tile: &mut Tile<'_>) {
            let Rect { x: left, y: top, width, height } = tile.rect();
            let mut rows = 0;
            for (y, row) in tile.rows() {
                assert_eq!((y, row.len() as u32), (top + rows, width));
                (left..)
                    .zip(row)
                    .for_each(|(x, color)| *color = [x as f32, y as f32, color[2] + 1.0]);
                rows += 1;
            }
            assert_eq!(rows, height);
        }
    }
    for ((width, height), tile) in SIZES.into_iter().flat_map(|size| TILES.map(|t| (size, t))) {
        let mut image = Image::new(width, height).expect("an image");
        let tiles = image.tiles(NonZeroU32::new(tile).expect("not 0"));
        tiles.into_iter().for_each(|mut tile| Place.render(&mut tile));
        for (index, color) in image.pixels().iter().enumerate() {
            let (x, y) = image.position(index);
            assert_eq!(*color, [x as f32, y as f32, 1.0], "{width}x{height}, tiles of {tile}");
        }
    }
}
