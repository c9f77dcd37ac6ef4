//! (being written)
#![allow(missing_docs)]
use glam::DVec2;
pub struct TrueLines;
pub struct LineAccuracy { pub precision: f64, pub recall: f64 }
pub fn true_lines(_: &crate::scene::Scene, _: &crate::camera::Camera, _: (u32, u32), _: f64) -> TrueLines { TrueLines }
pub fn drawn_centreline(_: &[f64], _: u32, _: u32) -> Vec<DVec2> { Vec::new() }
pub fn accuracy(_: &TrueLines, _: &[DVec2], _: f64) -> LineAccuracy { LineAccuracy { precision: 0.0, recall: 0.0 } }
