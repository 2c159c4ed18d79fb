//! The same bits on processors that can do less. The C library picks its sine and its exponential by what the
//! processor can do, and they differ in the last bit; so a bake must not call them. Here the library is told that the
//! processor can do nothing of the kind, in a second run of this program, and the bakes must not notice.

use crate::fingerprint::Fingerprint;
use crate::held::HELD;
use std::process::Command;

/// What a run prints per bake, and for the C library itself.
const MARK: &str = "bits of";

/// A hash of some values of the C library's functions.
fn library_hash() -> u64 {
    let values = (1..20_000_u32).map(|step| {
        let x = f64::from(step) * 1e-3;
        std::hint::black_box(x).sin() + std::hint::black_box(x).ln() + std::hint::black_box(-x).exp()
    });
    values.fold(0, |hash: u64, value| hash.rotate_left(5).wrapping_mul(0x100_0000_01b3) ^ value.to_bits())
}

fn lines() -> Vec<String> {
    let bakes = HELD.iter().map(|held| (held.name, Fingerprint::of(&held.bake(2)).hash()));
    bakes.chain([("library", library_hash())]).map(|(name, hash)| format!("{MARK} {name} {hash:#018x}")).collect()
}

/// Not a test of its own: what the second run does.
#[test]
#[ignore = "prints what another test reads"]
fn print_fingerprints() {
    lines().iter().for_each(|line| println!("{line}"));
}

/// What a second run of this program prints, with the GNU C library told to do without these features of the
/// processor.
fn run_without(features: &str) -> Vec<String> {
    let program = std::env::current_exe().unwrap();
    let run = Command::new(program)
        .args(["--exact", "machines::print_fingerprints", "--ignored", "--nocapture"])
        .env("GLIBC_TUNABLES", format!("glibc.cpu.hwcaps={features}"))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.success(), "{text}\n{}", String::from_utf8_lossy(&run.stderr));
    // The harness may print before the first line without ending it.
    text.lines().filter_map(|line| line.find(MARK).map(|start| line[start..].to_owned())).collect()
}

/// The bakes among the lines of a run that are not those of another.
fn moved(a: &[String], b: &[String]) -> Vec<String> {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a != b).map(|(a, b)| format!("{a} and {b}")).collect()
}

#[test]
#[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
fn a_processor_that_can_do_less() {
    let here = lines();
    let less = run_without("-AVX2,-FMA,-FMA4,-AVX,-AVX512F,-AVX2_Usable,-FMA_Usable,-FMA4_Usable,-AVX_Usable");
    assert_eq!(here.len(), HELD.len() + 1);
    let moved = moved(&here, &less);
    let (library, bakes): (Vec<_>, Vec<_>) = moved.into_iter().partition(|line| line.contains(" library "));
    assert!(bakes.is_empty(), "another processor bakes other bits: {bakes:?}");
    // The planted fault: the library's own values do differ, where the processor gave it a choice, and it is seen.
    if library.is_empty() && std::arch::is_x86_feature_detected!("fma") {
        assert!(std::env::var_os("CI").is_none(), "the C library was not told to do without: nothing was tested");
        println!("skipped: this C library cannot be told to do without features of the processor");
    }
}
