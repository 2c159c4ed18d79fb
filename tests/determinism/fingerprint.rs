//! All numbers of a result, by name, and whether two results are the same to the bit. Times are left out: they are of
//! the machine, not of the light.

use bevy_kiln::bake::{BakeReport, Lightmap, MeterReading, Page, Placement};
use glam::Vec3;

/// The bits of all numbers of a result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fingerprint {
    parts: Vec<Part>,
}

/// Numbers of one kind, in order.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Part {
    name: String,
    bits: Vec<u64>,
}

impl Fingerprint {
    /// Of a lightmap: texels, places, lights and report.
    pub fn of(lightmap: &Lightmap) -> Self {
        let pages = lightmap.pages.iter().enumerate().flat_map(|(number, page)| page_parts(number, page));
        let places = Part::new("placements", lightmap.placements.iter().flat_map(place));
        let lights = Part::new("lights", lightmap.baked_lights.iter().map(|id| id.key()));
        let rest = [places, lights, report(&lightmap.report)];
        Self { parts: pages.chain(rest).collect() }
    }

    /// Of readings of the light meter.
    pub fn of_readings(readings: &[MeterReading]) -> Self {
        let numbers = |reading: &MeterReading| {
            let [light, error] = [reading.irradiance, reading.stderr].map(|light| light.to_array());
            [light, error].into_iter().flatten().map(f64::to_bits).chain([reading.samples]).collect::<Vec<_>>()
        };
        Self { parts: vec![Part::new("readings", readings.iter().flat_map(numbers))] }
    }

    /// FNV-1a (Fowler, Noll and Vo 1991) over names and bits. Each of its steps is a bijection, so that no change of a
    /// single number is lost.
    pub fn hash(&self) -> u64 {
        let bytes = |part: &Part| {
            let bits = part.bits.iter().flat_map(|bits| bits.to_le_bytes());
            part.name.bytes().chain(bits).collect::<Vec<u8>>()
        };
        let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        self.parts.iter().flat_map(bytes).fold(0xcbf2_9ce4_8422_2325, step)
    }

    /// How many numbers there are.
    pub fn len(&self) -> usize {
        self.parts.iter().map(|part| part.bits.len()).sum()
    }

    /// Whether two results are the same to the bit; if not, where they part first, and in how many numbers they
    /// differ.
    pub fn same(&self, other: &Self) -> Result<(), String> {
        let names = |of: &Self| of.parts.iter().map(|part| (part.name.clone(), part.bits.len())).collect::<Vec<_>>();
        if names(self) != names(other) {
            return Err(format!("results of other shapes: {:?} and {:?}", names(self), names(other)));
        }
        let pairs = self.parts.iter().zip(&other.parts).flat_map(|(a, b)| {
            a.bits.iter().zip(&b.bits).enumerate().map(move |(index, (x, y))| (&a.name, index, *x, *y))
        });
        let apart: Vec<_> = pairs.filter(|(_, _, x, y)| x != y).collect();
        match apart.first() {
            None => Ok(()),
            Some((name, index, x, y)) => Err(format!(
                "{} of {} numbers differ, the first of them {name}[{index}]: {x:#x} and {y:#x}",
                apart.len(),
                self.len()
            )),
        }
    }

    /// The same with one bit turned.
    pub fn with_bit_turned(&self, part: usize, number: usize, bit: u32) -> Self {
        let mut turned = self.clone();
        let bits = &mut turned.parts[part].bits;
        let number = number % bits.len();
        bits[number] ^= 1 << bit;
        turned
    }
}

/// Panics where two bakes are not the same to the bit.
pub fn assert_same(a: &Lightmap, b: &Lightmap) {
    assert_eq!(Fingerprint::of(a).same(&Fingerprint::of(b)), Ok(()));
    assert_eq!(a.placements, b.placements);
    assert_eq!(a.baked_lights, b.baked_lights);
}

impl Part {
    fn new(name: impl Into<String>, bits: impl IntoIterator<Item = u64>) -> Self {
        Self { name: name.into(), bits: bits.into_iter().collect() }
    }
}

fn page_parts(number: usize, page: &Page) -> [Part; 5] {
    let floats = |name: &str, values: Vec<f32>| {
        Part::new(format!("page {number}, {name}"), values.into_iter().map(|value| u64::from(value.to_bits())))
    };
    let colours =
        |name: &str, values: &[Vec3]| floats(name, values.iter().flat_map(|value| value.to_array()).collect());
    let size = [page.width, page.height].map(u64::from);
    [
        Part::new(format!("page {number}, size"), size),
        colours("radiance", &page.radiance),
        colours("raw", &page.raw),
        colours("stderr", &page.stderr),
        floats("coverage", page.coverage.clone()),
    ]
}

fn place(place: &Placement) -> [u64; 6] {
    let [u0, v0] = place.uv_min.map(|value| u64::from(value.to_bits()));
    let [u1, v1] = place.uv_max.map(|value| u64::from(value.to_bits()));
    [place.id.key(), u64::from(place.page), u0, v0, u1, v1]
}

fn report(report: &BakeReport) -> Part {
    let errors = report.relative_stderr;
    // An open scene has no balance; the bits of 0 stand for that, which no balance is.
    let numbers = [errors.mean, errors.p95, errors.max, report.energy_balance.unwrap_or(0.0)].map(f64::to_bits);
    Part::new("report", [report.texels, report.samples, report.rays].into_iter().chain(numbers))
}
