#!/usr/bin/env node
// Writes the objects of the Utah teapot as JSON to standard output:  node scenes/generate-teapot.mjs
//
// Martin Newell's teapot (1975) with the lid and bottom of later versions: 32 bicubic patches from 10 patches
// and their mirror images. Heights are along y; the pot stands on y = 0 and its axis is the y axis.

// Control points of the quarter x >= 0, y <= 0, and of the half y <= 0 of handle and spout: x, y, z with z up.
const kRows = {
  lid_top: [[0, 0, 3.15], [0, 0, 3.15], [0, 0, 3.15], [0, 0, 3.15]],
  knob: [[0.8, 0, 3.15], [0.8, -0.45, 3.15], [0.45, -0.8, 3.15], [0, -0.8, 3.15]],
  knob_foot: [[0, 0, 2.85], [0, 0, 2.85], [0, 0, 2.85], [0, 0, 2.85]],
};
const kRim = 0.56; // x and y of the inner control points of a quarter circle are 1 and 0.56 radii

// Returns a row of a quarter of a surface of revolution: radius and height.
const ring = (r, z) => [[r, 0, z], [r, -kRim * r, z], [kRim * r, -r, z], [0, -r, z]];

const kQuarters = {
  rim: [ring(1.4, 2.4), ring(1.3375, 2.53125), ring(1.4375, 2.53125), ring(1.5, 2.4)],
  upper: [ring(1.5, 2.4), ring(1.75, 1.875), ring(2, 1.35), ring(2, 0.9)],
  lower: [ring(2, 0.9), ring(2, 0.45), ring(1.5, 0.225), ring(1.5, 0.15)],
};
