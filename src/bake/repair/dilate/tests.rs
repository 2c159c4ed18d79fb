//! What rings hold, and what they leave alone.

use super::*;
use crate::bake::CancelToken;
use crate::bake::repair::TexelState;
use crate::bake::validity::Links;

#[path = "tests/properties.rs"]
mod properties;

const SIZE: [u32; 2] = [24, 20];

/// A page with the texels of a chart where `chart` says so, linked to all around.
fn field(chart: impl Fn(u32, u32) -> Option<u32>, value: impl Fn(u32, u32) -> f32) -> Field {
    let mut field = Field::empty(SIZE);
    field.value.fill(Vec3::splat(-1.0));
    for index in 0..field.value.len() {
        let [x, y] = [index as u32 % SIZE[0], index as u32 / SIZE[0]];
        let Some(chart) = chart(x, y) else { continue };
        field.state[index] = TexelState::Measured;
        field.chart[index] = chart;
        field.links[index] = Links::ALL;
        field.value[index] = Vec3::splat(value(x, y));
    }
    field
}

fn dilated(mut field: Field) -> (Field, Owners) {
    let cancel = CancelToken::default();
    let workers = Workers::new(None, &(), &cancel).unwrap();
    let owners = dilate(&mut field, &workers).unwrap();
    (field, owners)
}

fn at(x: u32, y: u32) -> usize {
    (y * SIZE[0] + x) as usize
}

#[test]
fn a_slope_goes_on_beyond_its_chart_and_measured_texels_keep_their_bits() {
    let inside = |x, y| (6..14).contains(&x) && (5..13).contains(&y);
    let slope = |x: u32, y: u32| 40.0 + 2.0 * x as f32 - y as f32;
    let before = field(|x, y| inside(x, y).then_some(3), slope);
    let (after, owners) = dilated(before.clone());
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let index = at(x, y);
            if inside(x, y) {
                assert_eq!(after.value[index], before.value[index]);
                continue;
            }
            let beyond = |at: u32, low: u32, high: u32| low.saturating_sub(at).max(at.saturating_sub(high));
            let ring = beyond(x, 6, 13).max(beyond(y, 5, 12));
            if ring <= 2 {
                assert!((after.value[index].x - slope(x, y)).abs() < 0.1, "{x} {y}: {}", after.value[index].x);
            }
            // Rings, and what completes their blocks.
            let in_block = (0..=20).contains(&x) && (0..=19).contains(&y);
            assert_eq!(owners.source(index).is_some(), after.value[index].x >= 0.0);
            assert!(ring > PASSES || owners.source(index).is_some());
            assert!(in_block || owners.source(index).is_none(), "{x} {y}");
        }
    }
}

#[test]
fn charts_that_come_close_share_the_gap_and_do_not_mix() {
    // Black on the left, bright on the right, three texels between.
    let chart = |x, y| match x {
        2..=6 if (4..16).contains(&y) => Some(0),
        10..=14 if (4..16).contains(&y) => Some(1),
        _ => None,
    };
    let (after, _) = dilated(field(chart, |x, _| if x < 8 { 0.0 } else { 8.0 }));
    for y in 4..16 {
        let row: Vec<f32> = (2..=14).map(|x| after.value[at(x, y)].x).collect();
        assert!(row.iter().all(|&value| value == 0.0 || value == 8.0), "{row:?}");
        assert_eq!((row[5], row[7]), (0.0, 8.0), "{row:?}");
    }
}

#[test]
fn what_is_equal_stays_equal_and_a_hidden_texel_goes_by_its_own_chart() {
    let chart = |x, y| match x {
        2..=6 if (4..16).contains(&y) => Some(0),
        9..=14 if (4..16).contains(&y) => Some(1),
        _ => None,
    };
    let mut before = field(chart, |x, _| if x < 8 { 0.3 } else { 0.7 });
    before.state[at(8, 10)] = TexelState::Hidden;
    let (after, _) = dilated(before);
    assert_eq!(after.value[at(8, 10)].x, 0.3, "its neighbour is of another chart");
    assert_eq!(after.value[at(8, 11)].x, 0.7);
    for value in after.value.iter().filter(|value| value.x >= 0.0) {
        assert!(value.x == 0.3 || value.x == 0.7, "{value}");
    }
}

#[test]
fn a_texel_on_its_own_is_repeated() {
    let (after, _) = dilated(field(|x, y| (x == 9 && y == 9).then_some(0), |_, _| 5.0));
    assert_eq!(after.value[at(10, 8)], Vec3::splat(5.0));
    assert_eq!(after.value[at(5, 13)], Vec3::splat(5.0));
}
