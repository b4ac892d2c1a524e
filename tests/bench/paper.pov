// scenes/paper.json for POV-Ray 3.7: the same rays to the same depth. tests/povray checks that the images
// agree.
#version 3.7;
global_settings {
  assumed_gamma 1
  ambient_light rgb 0.4
  max_trace_level 6  // depth 5 in orrery, where camera rays have depth 0 instead of level 1
  adc_bailout 0      // traces all rays, however weak
}
background { rgb 0.4 }
camera {
  perspective
  location <0, 0, 4>
  direction <0, 0, -1>
  up y * 2 * tan(radians(45 / 2))
  right x * 2 * tan(radians(45 / 2))
}
light_source { <1, 1, 1> * 1e5 rgb 2 parallel point_at 0 }

// Metal by Schlick's approximation, from index of refraction and extinction coefficient.
#declare N = <0.14, 0.16, 0.13>;
#declare K = <4.1, 2.3, 3.1>;
#declare F0 = ((N - 1) * (N - 1) + K * K) / ((N + 1) * (N + 1) + K * K);
#declare Silver = texture {
  pigment { rgb 0 }
  finish { ambient 0 diffuse 0 reflection { rgb F0, rgb 1 falloff 5 } }
}
#declare Plum = texture {
  pigment { rgb <0.3, 0, 0.2> }
  finish { ambient 1 diffuse 1 specular 2 roughness 1 / 20 }
}
#declare Slate = texture {
  pigment { rgb <0.1, 0.2, 0.3> }
  finish { ambient 1 diffuse 1 specular 2 roughness 1 / 100 }
}

sphere { <-0.85, 0, 0>, 0.5 texture { Silver } }
sphere { <0, 0.5, -0.8>, 0.5 texture { Plum } }
cylinder { <0.55, -0.1, 0>, <0.55, 0.4, 0>, 0.4 texture { Slate } }
plane { y, -0.6 texture { Silver } }
