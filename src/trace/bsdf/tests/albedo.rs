//! The albedo tables against the lobe that they describe.

use super::super::albedo::{AlbedoTables, Quadrature};
use super::super::ggx::Ggx;
use glam::FloatExt;

#[test]
fn zz_explore() {
    let start = std::time::Instant::now();
    let tables = AlbedoTables::new();
    println!("{:?}", start.elapsed());
    let fine = Quadrature::new([96, 192]);
    let mut worst = (0.0_f32, 0.0, 0.0, 0.0, 0.0);
    for i in 0..24 {
        let r = 0.0317_f32.lerp(1.0, (i as f32 + 0.37) / 24.0);
        let ggx = Ggx::new(r).unwrap();
        let row = tables.at(r);
        let mut w = (0.0_f32, 0.0, 0.0, 0.0, 0.0);
        for j in 0..40 {
            let cos = ((j as f32 + 0.41) / 40.0).powi(3);
            let (t, e) = (row.at(cos), fine.albedo(&ggx, cos));
            let err = (t.f0 - e.f0).abs().max((t.f90 - e.f90).abs()).max((t.white() - e.white()).abs());
            if err > w.0 {
                w = (err, r, cos, t.white() - e.white(), t.f90 - e.f90);
            }
        }
        println!("{w:?}  Eavg {}", row.average().white());
        if w.0 > worst.0 {
            worst = w;
        }
    }
    println!("{worst:?}");
}
