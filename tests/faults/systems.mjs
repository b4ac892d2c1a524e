// Mistakes in atmospheres, the energy account and scan line rendering (16).

export const systemFaults = [
  {
    fault: 16,
    about: "fog does not attenuate the light of lamps",
    file: "core/lighting/shadowed_light.cpp",
    from: "  if (geometry_.atmosphere) geometry_.atmosphere->transmit_light(shadow.t_max, reached, light.incident);\n",
    to: "",
    target: "test_atmospheres",
    tests: ["Fog.AttenuatesPointLights", "Fog.AttenuatesLightSourcesAsRays"],
  },
  {
    fault: 16,
    about: "fog inside glass",
    file: "core/lighting/atmosphere_stage.h",
    from: "share_.put(i, inside && surface.side.at(i) < N(T(0)), N(T(1)));",
    to: "share_.put(i, inside && surface.side.at(i) > N(T(1)), N(T(1)));",
    target: "test_atmospheres",
    tests: ["Fog.LeavesLightInsideObjectsUnchanged"],
  },
  {
    fault: 16,
    about: "depth cue by the distance along the ray instead of the depth",
    file: "core/atmospheres/formula.h",
    from: "value = formula.share(distance, -dot(rays.at(i).at(distance) - eye, back));",
    to: "value = formula.share(distance, length(rays.at(i).at(distance) - eye) + dot(back, back) * T(0));",
    target: "test_atmospheres",
    tests: ["DepthCue.UsesDepthAlongViewAxis"],
  },
  {
    fault: 16,
    about: "energy account adds the transmitted light to the reflected light",
    file: "core/lighting/energy_account.cpp",
    from: "    (through ? sums.transmitted : sums.specular) += share(lane);",
    to: "    (through && share(lane) < 0 ? sums.transmitted : sums.specular) += share(lane);",
    target: "test_techniques",
    tests: ["Energy.MeasuresTransmittedShare"],
  },
  {
    fault: 16,
    about: "scan line draws coincident layers of transparent surfaces once",
    file: "core/raster/tile_raster.cpp",
    from: "(nearness < limit_.at(i) || (nearness == limit_.at(i) && mask_cast<N>(later)))",
    to: "nearness < limit_.at(i) && (mask_cast<N>(later) || !mask_cast<N>(later))",
    target: "test_techniques",
    tests: ["ScanLine.BlendsCoincidentTransparentSurfaces"],
  },
];
