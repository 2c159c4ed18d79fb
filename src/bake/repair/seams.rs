//! Seams: what lookups on the two sides of a chart's edge show. Owns the repair of the texels along joints, within a
//! mesh and between meshes that touch; changes nothing that no lookup at a joint reads.
//!
//! 1. `borders` finds the edges at which charts end and the stretches along which two of them meet (`tree`);
//! 2. `samples` puts points along them, and leaves out where the surface is not meant to be one;
//! 3. `across` gives texels filled in beside a joint what the other chart shows there;
//! 4. `solve` moves the texels of each group of joints that share any.

mod across;
mod borders;
mod samples;
mod solve;
mod tree;

use super::dilate::Owners;
use super::{Field, Surroundings};
use crate::bake::charts::{Charts, DisjointSets};
use crate::bake::workers::Workers;
use crate::bake::{BakeError, Jump, SeamReport};
use glam::DVec3;
use samples::{Sample, Sampling};
use solve::{Rows, Solution, Unknown, solve};

/// Bounds of the relative standard error that a measured texel may claim.
const LEAST_ERROR: f64 = 0.01;
const MOST_ERROR: f64 = 1.0;

/// What a filled texel is taken to be off: it is nobody's measurement.
const FILLED_ERROR: f64 = 0.25;

/// Share of the step to a neighbour that a texel may be off, since what was measured is its covered part and what is
/// read is its centre.
const OFF_CENTRE: f64 = 0.25;

/// How far apart both sides of a seam may be, in the sum of their errors, to be taken for one.
const EXPLAINED: f64 = 8.0;

/// A texel that no lookup at a joint reads by this share is moved less, as if it were more certain: it would have to
/// move by many times of what it does for the joint.
const FULL_SHARE: f64 = 0.08;

/// How far a measured texel may be moved, in its error.
const REACH: f64 = 8.0;

/// What the least local value falls to from a lookup to the farthest that share texels with it, and how often that is
/// carried on.
const FALL_OFF: f64 = 0.9;
const SPREAD: u32 = 12;

/// A texel: page and number.
type Place = (u32, u32);

/// Mends the seams of all pages, in place. `None` where no charts meet.
pub(super) fn mend(
    fields: &mut [Field],
    owners: &[Owners],
    place: &Surroundings<'_>,
    workers: &Workers<'_>,
) -> Result<Option<SeamReport>, BakeError> {
    let mut samples = samples(fields, owners, place, workers)?;
    if samples.is_empty() {
        return Ok(None);
    }
    across::read_across(fields, &samples);
    samples = samples.into_iter().filter_map(|Sample { joint, sides, .. }| Sample::new(joint, sides, fields)).collect();
    let system = System::new(&samples);
    system.spread(&mut samples);
    let groups = system.groups(&samples);
    let solutions = workers.gather_quietly(&groups, |group, cancel| {
        let (rows, unknowns) = system.group(group, &samples, fields, owners);
        solve(&rows, &unknowns, cancel)
    })?;
    for (group, solution) in groups.iter().zip(&solutions) {
        for (&unknown, &step) in group.unknowns.iter().zip(&solution.moves).filter(|(_, step)| **step != DVec3::ZERO) {
            let (page, texel) = system.places[unknown as usize];
            let value = &mut fields[page as usize].value[texel as usize];
            *value = (value.as_dvec3() + step).max(DVec3::ZERO).as_vec3();
        }
    }
    Ok(Some(report(&samples, &solutions)))
}

/// All samples, joint by joint.
fn samples(
    fields: &[Field],
    owners: &[Owners],
    place: &Surroundings<'_>,
    workers: &Workers<'_>,
) -> Result<Vec<Sample>, BakeError> {
    let borders = borders::borders(place, workers)?;
    let joints = borders::joints(&borders, workers)?;
    let mut sites: Vec<Vec<u32>> = fields.iter().map(|field| vec![u32::MAX; field.value.len()]).collect();
    for (number, site) in place.sites.iter().enumerate() {
        sites[site.covered.page as usize][site.covered.index as usize] = number as u32;
    }
    let sampling = Sampling {
        place,
        fields,
        owners,
        borders: &borders,
        charts: Charts::new(place.tracer, &place.atlas.charts),
        sites,
        rects: (0..place.atlas.charts.len() as u32).map(|receiver| place.rect(receiver)).collect(),
    };
    let numbers: Vec<u32> = (0..joints.len() as u32).collect();
    let of_each = workers.gather_quietly(&numbers, |&number, cancel| {
        (!cancel.is_cancelled()).then(|| sampling.samples(number, &joints[number as usize]))
    })?;
    Ok(of_each.into_iter().flatten().collect())
}

/// All unknowns.
struct System {
    /// Where they are, in order.
    places: Vec<Place>,
    /// Their numbers, entry by entry through all samples.
    numbers: Vec<u32>,
    /// Where each sample's entries begin.
    begins: Vec<usize>,
}

/// Joints that share texels.
struct Group {
    samples: Vec<u32>,
    unknowns: Vec<u32>,
}

fn entries(sample: &Sample) -> impl Iterator<Item = &samples::Entry> {
    sample.rows.iter().flat_map(|row| &row.entries)
}

impl System {
    fn new(samples: &[Sample]) -> Self {
        let mut places: Vec<Place> = samples.iter().flat_map(entries).map(|entry| entry.texel).collect();
        places.sort_unstable();
        places.dedup();
        let (mut numbers, mut begins) = (Vec::new(), Vec::new());
        for sample in samples {
            begins.push(numbers.len());
            // Each place is in the list.
            numbers.extend(entries(sample).map(|entry| places.partition_point(|place| *place < entry.texel) as u32));
        }
        Self { places, numbers, begins }
    }

    fn of(&self, sample: usize) -> &[u32] {
        let end = self.begins.get(sample + 1).copied().unwrap_or(self.numbers.len());
        &self.numbers[self.begins[sample]..end]
    }

    /// Spreads the least local values along the seams, from lookup to lookup that share texels, falling off.
    fn spread(&self, samples: &mut [Sample]) {
        let mut at = vec![0.0_f64; self.places.len()];
        for _ in 0..SPREAD {
            for (number, sample) in samples.iter().enumerate() {
                let floor = FALL_OFF * sample.floor;
                self.of(number).iter().for_each(|&unknown| at[unknown as usize] = at[unknown as usize].max(floor));
            }
            for (number, sample) in samples.iter_mut().enumerate() {
                sample.floor =
                    self.of(number).iter().fold(sample.floor, |most, &unknown| most.max(at[unknown as usize]));
            }
        }
    }

    /// Groups by their first unknown, with samples and unknowns in order.
    fn groups(&self, samples: &[Sample]) -> Vec<Group> {
        let mut sets = DisjointSets::new(self.places.len() as u32);
        for sample in 0..samples.len() {
            self.of(sample).windows(2).for_each(|pair| sets.join(pair[0], pair[1]));
        }
        let mut number_of_root = vec![u32::MAX; self.places.len()];
        let mut groups: Vec<Group> = Vec::new();
        for unknown in 0..self.places.len() as u32 {
            // The root is the smallest of its set, and comes first.
            let root = sets.root(unknown) as usize;
            if number_of_root[root] == u32::MAX {
                number_of_root[root] = groups.len() as u32;
                groups.push(Group { samples: Vec::new(), unknowns: Vec::new() });
            }
            groups[number_of_root[root] as usize].unknowns.push(unknown);
        }
        for sample in 0..samples.len() {
            if let Some(&first) = self.of(sample).first() {
                groups[number_of_root[sets.root(first) as usize] as usize].samples.push(sample as u32);
            }
        }
        groups
    }

    /// The equations of a group.
    fn group(&self, group: &Group, samples: &[Sample], fields: &[Field], owners: &[Owners]) -> (Rows, Vec<Unknown>) {
        let local_number = |unknown: u32| group.unknowns.partition_point(|&known| known < unknown) as u32;
        let mut rows = Rows::default();
        let mut locals = vec![(0.0, 0.0); group.unknowns.len()];
        let mut shares = vec![0.0_f64; group.unknowns.len()];
        for &sample in &group.samples {
            let numbers: Vec<u32> = self.of(sample as usize).iter().copied().map(local_number).collect();
            let sample = &samples[sample as usize];
            let mut begin = 0;
            for row in &sample.rows {
                let of_row = &numbers[begin..begin + row.entries.len()];
                begin += row.entries.len();
                let entries = || of_row.iter().copied().zip(row.entries.iter().map(|entry| entry.weight));
                let measured = entries().filter_map(|(number, weight)| {
                    let (page, texel) = self.places[group.unknowns[number as usize] as usize];
                    let (field, texel) = (&fields[page as usize], texel as usize);
                    field.is_measured(texel).then(|| (weight, field.value[texel].as_dvec3(), error_of(field, texel)))
                });
                if !may_agree(measured) {
                    continue;
                }
                for (number, weight) in entries() {
                    let (sum, weights) = &mut locals[number as usize];
                    *sum += weight * weight * row.local();
                    *weights += weight * weight;
                    let share = &mut shares[number as usize];
                    *share = share.max(weight.abs());
                }
                rows.push([row.difference, row.mean], sample.floor, entries());
            }
        }
        let unknown = |((&number, (sum, weights)), share): ((&u32, (f64, f64)), f64)| {
            let (page, texel) = self.places[number as usize];
            let (field, texel) = (&fields[page as usize], texel as usize);
            let local: f64 = sum / weights;
            let measured = |source: usize| error_of(field, source) / local;
            let error = match owners[page as usize].source(texel) {
                Some(source) if source == texel => measured(source).clamp(LEAST_ERROR, MOST_ERROR),
                Some(source) => measured(source).clamp(FILLED_ERROR, MOST_ERROR),
                None => FILLED_ERROR,
            };
            let error = error * (share / FULL_SHARE).min(1.0);
            let reach = if field.is_measured(texel) { REACH * error * local } else { f64::INFINITY };
            Unknown { value: field.value[texel].as_dvec3(), error: error * local, reach }
        };
        let unknowns = group.unknowns.iter().zip(locals).zip(shares).map(unknown).collect();
        (rows, unknowns)
    }
}

/// How far off a measured texel may be at the places where lookups read it [cd/m²].
fn error_of(field: &Field, texel: usize) -> f64 {
    let off = OFF_CENTRE * steepness(field, texel);
    let least = LEAST_ERROR * f64::from(field.value[texel].max_element());
    f64::from(field.stderr[texel].max_element()).max(off).max(least)
}

/// Whether two lookups could agree: what was measured on both sides (told by the sign of the weights) differs by no
/// more than errors and slopes explain. Where it does, the light itself has an edge, which no solve may blur.
fn may_agree(measured: impl Iterator<Item = (f64, DVec3, f64)>) -> bool {
    let mut sides = [(0.0, DVec3::ZERO, 0.0); 2];
    for (weight, value, error) in measured {
        let (weights, values, errors) = &mut sides[usize::from(weight < 0.0)];
        *weights += weight.abs();
        *values += weight.abs() * value;
        *errors += weight.abs() * error;
    }
    if sides.iter().any(|(weights, ..)| *weights == 0.0) {
        return false;
    }
    let [a, b] = sides.map(|(weights, values, errors)| (values / weights, errors / weights));
    (a.0 - b.0).abs().max_element() <= EXPLAINED * (a.1 + b.1)
}

/// The largest step from a measured texel to one that it is linked with [cd/m²].
fn steepness(field: &Field, texel: usize) -> f64 {
    let steps = (-1..=1).flat_map(|y| (-1..=1).map(move |x| [x, y]));
    let linked = steps.filter(|&step| field.links[texel].reaches(step)).filter_map(|step| field.step(texel, step));
    linked.fold(0.0, |most, other| most.max((field.value[texel] - field.value[other]).abs().max_element().into()))
}

fn report(samples: &[Sample], solutions: &[Solution]) -> SeamReport {
    let jump = |of: fn(&Solution) -> &Vec<f64>| Jump::of(solutions.iter().flat_map(of).copied().collect());
    let mut joints: Vec<u32> = samples.iter().map(|sample| sample.joint).collect();
    joints.dedup();
    SeamReport {
        joints: joints.len() as u64,
        samples: samples.len() as u64,
        before: jump(|solution| &solution.before),
        after: jump(|solution| &solution.after),
    }
}
