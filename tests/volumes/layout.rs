//! Whether Bevy's shader finds each face of each probe where the texture has it.

use crate::common::volume::{Bound, look_up};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{ProbeState, Volume};
use bevy_kiln::output::VolumeTexture;
use glam::{Quat, UVec3, Vec3};

const AXES: [Vec3; 6] = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];

/// Every face of every probe has a value of its own.
fn numbered() -> Volume {
    let resolution = UVec3::new(3, 2, 4);
    let cube =
        |probe: u32| std::array::from_fn(|face| Vec3::new(probe as f32, face as f32 + 1.0, 100.0 - probe as f32));
    Volume {
        id: StableId::new("numbered"),
        centre: Vec3::new(1.0, -2.0, 3.0),
        rotation: Quat::IDENTITY,
        size: Vec3::new(3.0, 4.0, 2.0),
        resolution,
        falloff: 0.0,
        cubes: (0..resolution.element_product()).map(cube).collect(),
        probes: vec![ProbeState::Measured; 24],
    }
}

fn probe_point(volume: &Volume, cell: UVec3) -> Vec3 {
    let share = (cell.as_vec3() + 0.5) / volume.resolution.as_vec3() - 0.5;
    volume.centre + volume.rotation * (share * volume.size)
}

fn cells(volume: &Volume) -> impl Iterator<Item = (usize, UVec3)> + use<> {
    let [x, y, z] = volume.resolution.to_array();
    (0..z).flat_map(move |k| (0..y).flat_map(move |j| (0..x).map(move |i| UVec3::new(i, j, k)))).enumerate()
}

/// Whether all six normals get their face at every probe's place, as the shader reads this texture.
fn faces_are_found(volume: &Volume, texture: VolumeTexture) -> bool {
    let bound = [Bound::with_texture(volume, texture)];
    cells(volume).all(|(probe, cell)| {
        (0..6).all(|face| {
            let seen = look_up(&bound, probe_point(volume, cell), AXES[face]);
            (seen - volume.cubes[probe][face]).length() < 1e-3
        })
    })
}

#[test]
fn each_normal_gets_its_face() {
    let mut volume = numbered();
    assert!(faces_are_found(&volume, VolumeTexture::new(&volume)));
    volume.rotation = Quat::from_euler(glam::EulerRot::YXZ, 0.4, 1.1, -0.3);
    assert!(faces_are_found(&volume, VolumeTexture::new(&volume)), "places turn with the box, faces do not");
}

#[test]
fn what_is_packed_otherwise_is_found_out() {
    let volume = numbered();
    let right = VolumeTexture::new(&volume);
    let rebuilt = |from: &dyn Fn(UVec3) -> UVec3| {
        let size = right.size;
        let at = |place: UVec3| right.texels[((place.z * size.y + place.y) * size.x + place.x) as usize];
        let places =
            (0..size.z).flat_map(|z| (0..size.y).flat_map(move |y| (0..size.x).map(move |x| UVec3::new(x, y, z))));
        VolumeTexture { size, texels: places.map(|place| at(from(place))).collect() }
    };
    let (rows, slices) = (volume.resolution.y, volume.resolution.z);
    assert!(faces_are_found(&volume, rebuilt(&|place| place)));
    // As Bevy's own documentation has it: the negative half first.
    let halves = |place: UVec3| place.with_y((place.y + rows) % (2 * rows));
    assert!(!faces_are_found(&volume, rebuilt(&halves)));
    assert!(!faces_are_found(&volume, rebuilt(&|place| place.with_z((place.z + slices) % (3 * slices)))));
    assert!(!faces_are_found(&volume, rebuilt(&|place| place.with_x(volume.resolution.x - 1 - place.x))));
    assert!(!faces_are_found(
        &volume,
        rebuilt(&|place| {
            let [pair, within] = [place.y / rows, place.y % rows];
            place.with_y(pair * rows + rows - 1 - within)
        })
    ));
}

#[test]
fn a_slanted_normal_mixes_three_faces_and_a_place_between_eight_probes() {
    let volume = numbered();
    let bound = [Bound::new(&volume)];
    let [first, corner] = [UVec3::new(1, 0, 2), UVec3::new(2, 1, 3)].map(|cell| probe_point(&volume, cell));
    let slanted = Vec3::new(1.0, -1.0, 1.0).normalize();
    let probe = |cell: UVec3| ((cell.z * 2 + cell.y) * 3 + cell.x) as usize;
    let cube = volume.cubes[probe(UVec3::new(1, 0, 2))];
    let seen = look_up(&bound, first, slanted);
    assert!((seen - (cube[0] + cube[3] + cube[4]) / 3.0).length() < 1e-3, "{seen}");
    let share = Vec3::new(0.25, 0.5, 0.8);
    let mut expected = Vec3::ZERO;
    for corner in 0..8_u32 {
        let offset = UVec3::new(corner & 1, corner >> 1 & 1, corner >> 2);
        let weight = Vec3::select(offset.cmpgt(UVec3::ZERO), share, 1.0 - share).element_product();
        expected += weight * volume.cubes[probe(UVec3::new(1, 0, 2) + offset)][2];
    }
    let seen = look_up(&bound, first + (corner - first) * share, Vec3::Y);
    assert!((seen - expected).length() < 1e-2, "{seen} {expected}");
}

/// Between the outermost probe and the face of the box nothing changes, and no other face bleeds in.
#[test]
fn beyond_the_outermost_probes_nothing_changes() {
    let volume = numbered();
    let bound = [Bound::new(&volume)];
    for (probe, cell) in cells(&volume) {
        let towards = |at: u32, of: u32| {
            if at == 0 {
                -0.499
            } else if at + 1 == of {
                0.499
            } else {
                0.0
            }
        };
        let aside = Vec3::new(towards(cell.x, 3), towards(cell.y, 2), towards(cell.z, 4));
        let point = probe_point(&volume, cell) + aside * volume.size / volume.resolution.as_vec3();
        for (face, axis) in AXES.into_iter().enumerate() {
            let seen = look_up(&bound, point, axis);
            assert!((seen - volume.cubes[probe][face]).length() < 1e-3, "{cell} {axis}: {seen}");
        }
    }
    assert_eq!(look_up(&bound, volume.centre + 0.51 * volume.size.with_y(0.0), Vec3::Y), Vec3::ZERO, "outside");
}
