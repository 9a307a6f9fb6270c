#![allow(missing_docs)]
use bunting_lab::{oracles::{rig::*, specimen::Specimen}, product::Product, scenes::*, simulation::Simulation};
use bunting_solver::{StepSettings};
use glam::*;
fn main() {
    for (substeps, damping, secs) in [(3u32,0.0,3.0),(6,0.0,3.0),(10,0.0,3.0),(10,2.0,6.0),(10,40.0,3.0),(30,2.0,6.0),(30,0.0,6.0)] {
        for (pins, above) in [(Pins::Top,0.0),(Pins::Free,0.5)] {
        let scheme=StepSettings::yarns(substeps);
        let strip = strip(32, 1.0, pins, Pose::Vertical, chains(1e4));
        let scene = Scene { gravity: 0.0, damping, ..strip };
        for framed in [true,false] {
        let mut s = Product::lone(scheme).start(&scene);
        let p: Vec<DVec3> = scene.positions().iter().map(|x| *x+DVec3::Y*above).collect();
        let v: Vec<DVec3> = p.iter().map(|x| (DVec3::X * 20.0).cross(*x)).collect();
        if !framed && damping>0.0 {continue;}
        s.place(&p, &v); if framed {s.spin(20.0);} 
        let ticks=(secs*60.0) as usize; let mut sum=0.0; let mut w=0.0; let mut mx=0.0f64; let mut mn=1.0f64;
        for k in 0..ticks { s.tick(); if k>=ticks/2 { let e=row(&scene,&s,32).distance(row(&scene,&s,0))-1.0; sum+=e; mx=mx.max(e); mn=mn.min(e);
            let vv=(s.velocities()[64]-s.velocities()[0]).as_dvec3(); w+=vv.length()/(1.0+e);} }
        let n=(ticks-ticks/2) as f64;
        println!("spin {pins:?} framed {framed} sub {substeps} c={damping} mean {:.4e} min {mn:.4e} max {mx:.4e} rate {:.3} -> normalised {:.4e}", sum/n, w/n, sum/n*(20.0/(w/n)).powi(2));
        }}
    }
    for substeps in [3u32,12] {
        let fabric = bunting_lab::scenes::Fabric { bending: 100.0, ..bunting_lab::scenes::Fabric::STANDARD };
        let scene = strip(8,1.0,Pins::Top,Pose::Vertical,fabric);
        let mut s = Product::lone(StepSettings::yarns(substeps)).start(&scene);
        let t: Vec<DVec3>=scene.positions().iter().map(|x| dvec3(x.x,0.0,-x.y*-1.0*-1.0)).collect();
        s.place(&t,&vec![DVec3::ZERO;t.len()]);
        for k in 0..600 { s.tick(); if k%40==0 || (k>560&&k%6==0) { let p=s.positions(); let e: f32 = (p[16]-p[17]).length(); println!("{substeps} {k} {} | twist tip {:?} mid {:?} len {e}", row(&scene,&s,8), p[17]-p[16], p[9]-p[8]); } }
    }
}
