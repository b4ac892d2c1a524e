#!/usr/bin/env node
// The systems that orrery models: how to reach each from scene JSON or the API, a sample scene, and a test.
//
//   node tests/lint/systems.mjs > docs/systems.md     writes the table

import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const kRoot = dirname(dirname(dirname(fileURLToPath(import.meta.url))));

// Groups of rows [id, system, how to reach it, sample scenes, tests]. Words in backquotes under "how to reach it"
// are keys or values of the scene schema, paths of the API or commands.
export const kGroups = [
  [
    "Light on a surface",
    [
      ["L1", "ambient light", "`ambient`, `ka`", "paper", "Ambient.ShowsAlbedoUnderUniformLight"],
      ["L2", "Lambert diffuse", "`rough` with `kd`, `lambert`", "material-rough", "Lambert.EqualsClampedCosine"],
      ["L3", "Phong highlight", "`rough` with `phong`", "material-rough", "Highlight.EqualsPowerOfCosine"],
      [
        "L4",
        "Blinn-Phong highlight",
        "`rough` with `blinn-phong`",
        "material-rough",
        "Highlight.UsesHalfVectorOfEachPoint",
      ],
      ["L5", "distance attenuation", "`attenuation`", "light-point", "Attenuation.ClampsFormulaToOne"],
      [
        "L6",
        "depth cueing, fog",
        "`depth_cue`, `fog`",
        "atmosphere-depth-cue, atmosphere-fog",
        "DepthCue.BlendsByDepthBetweenPlanes, Fog.AttenuatesExponentiallyInEveryTechnique",
      ],
      [
        "L7",
        "colour",
        "`diffuse_color`, `specular_color`, `intensity`",
        "material-rough",
        "Rough.MultipliesCoefficientsByColours",
      ],
      [
        "L8",
        "light sources",
        "`directional`, `point`, `spot`, `line`, `emission`, `environment`",
        "light-directional, light-point, light-spot, light-line, lamps",
        "AllLights.SendsUnitDirectionsWithinIntensity, LampIllumination.MatchesIntegralOverLamp, ImageEnvironment.MatchesSumOverDirections",
      ],
      [
        "L9",
        "Fresnel reflectance",
        "`fresnel`: `schlick`, `exact`; `n`, `k`",
        "material-reflective",
        "Fresnel.MatchesTextbookForDielectrics, Fresnel.MatchesTextbookForConductors, Fresnel.HasDocumentedSchlickError",
      ],
      [
        "L10",
        "Hall 1983",
        "`hall`",
        "material-hall",
        "Hall.TransmitsHighlightAlongRefractingFacet, Hall.SplitsRaysByFresnelAndFiltersThem",
      ],
      [
        "L11",
        "energy account",
        "`energy`",
        "glass",
        "Energy.SumsToOneForMaterialsThatAbsorbNothing, Energy.IsNegativeIfMaterialCreatesEnergy",
      ],
      [
        "L12",
        "textures",
        "`textures`: `image`, `checker`, `marble`, `wood`, `noise`; `bump`",
        "texture-checker, texture-noise, texture-bump",
        "Checker.AveragesIntervalsExactly, GradientNoise.HasPeriod256, ImagePyramid.ReturnsTexelsAtTheirCentres",
      ],
      [
        "L13",
        "subsurface scattering, fog in bodies",
        "`subsurface` with `albedo`, `mean_free_path`, `anisotropy`",
        "subsurface",
        "Subsurface.SlabMatchesDiscreteOrdinates, Subsurface.IsInvisibleInUniformLight, Subsurface.WithoutAlbedoEqualsFilterOfGlass",
      ],
    ],
  ],
  [
    "Polygons and transparency",
    [
      [
        "G1",
        "flat shading",
        "`flat`",
        "technique-polygon-shading",
        "ScanLine.EqualsRayCastingOnPlanesUnderDirectionalLight",
      ],
      ["G2", "Gouraud shading", "`gouraud`", "technique-polygon-shading", "Gouraud.EqualsIncrementalFormOnScreen"],
      ["G3", "Phong shading", "`phong`", "technique-polygon-shading", "Phong.ConvergesToRayCastingOnBall"],
      [
        "G4",
        "vertex normals",
        "`crease_degrees`",
        "shape-mesh",
        "SmoothNormals.ConvergesToNormalsOfSphere, SmoothNormals.SeparatesFacesAtExactCreaseAngle",
      ],
      [
        "G5",
        "known faults of polygon shading",
        "`tessellation_error`, `interpolation`",
        "polygon-mach-bands, polygon-lost-highlight, polygon-silhouette, polygon-perspective, polygon-orientation, polygon-t-vertices, polygon-normals",
        "PolygonFaults.MatchesTableOfDocumentation",
      ],
      [
        "G6",
        "interpolated transparency",
        "`transparent` with `interpolated`",
        "material-transparent",
        "Transparency.MatchesFormulasOnStacksOfPanes",
      ],
      [
        "G7",
        "filtered transparency",
        "`transparent` with `filtered`",
        "material-transparent",
        "Transparency.MatchesFormulasOnStacksOfPanes",
      ],
      [
        "G8",
        "refraction, nested media",
        "`refractive`, `glass`, `priority`",
        "material-refractive, nested-media",
        "Refraction.FollowsSnellsLaw, Refraction.ReflectsTotallyBeyondCriticalAngle, NestedMedia.MatchesPlatesOfThreeMedia",
      ],
    ],
  ],
  [
    "Techniques",
    [
      ["T1", "ray casting (Appel 1968)", "`raycast`", "paper", "EveryScene.MatchesRaycastAtDepthZero"],
      [
        "T2",
        "Whitted 1980",
        "`whitted`, `max_depth`, `min_contribution`",
        "mirrors, glass",
        "RayTree.MatchesRayCountFormula, Povray.RendersSameImage",
      ],
      [
        "T3",
        "distributed (Cook 1984)",
        "`distributed`",
        "technique-distributed",
        "Distributed.MatchesPathTracingWithoutDiffuseLobes",
      ],
      ["T4", "path tracing (Kajiya 1986)", "`path`", "cornell-box", "CornellBox.MatchesCyclesByPathLength"],
      [
        "T5",
        "scan line",
        "`flat`, `gouraud`, `phong`",
        "technique-polygon-shading",
        "ScanLine.HasSilhouetteOfRayCastingForEveryShape",
      ],
      ["T6", "ray accounting", "`--stats`", "mirrors", "RayTree.MatchesRayCountFormula"],
    ],
  ],
  [
    "Shapes",
    [
      ["S", "sphere", "`sphere`", "shape-sphere", "Sphere.DecidesFloatRaysWithinFewUlp"],
      [
        "S",
        "plane, disk, box",
        "`plane`, `disk`, `box`",
        "shape-plane, shape-disk, shape-box",
        "FlatShapes.FindsPlaneAtAnySlant, Box.ReportsNormalOfHitFace",
      ],
      [
        "S",
        "triangle, mesh",
        "`triangle`, `mesh`",
        "shape-triangle, shape-mesh",
        "Triangle.KeepsGrazingHitsOnSlivers, Mesh.DoesNotLeakAtEdgesAndVertices",
      ],
      [
        "S",
        "cylinder, finite and infinite",
        "`cylinder`",
        "shape-cylinder, shape-infinite-cylinder",
        "Cylinder.DividesRootsByTwiceA",
      ],
      [
        "S",
        "cone, torus",
        "`cone`, `torus`",
        "shape-cone, shape-torus",
        "Cone.MatchesHeightFunctionWithinRoundingUnitsInDouble, Torus.FindsDistancesTo1e12InDouble",
      ],
      [
        "S",
        "Bezier patch, NURBS",
        "`patch`, `nurbs`",
        "shape-patch, shape-nurbs",
        "Bezier.MatchesDeCasteljauInDouble, Revolved.MatchesClosedFormTo1e12",
      ],
      ["S", "ellipsoid", "`sphere` in `instances` with `scale`", "shape-ellipsoid", "Instance.MakesEllipsoidOfSphere"],
      ["S", "instances", "`models`, `instances`", "instances", "Instance.MatchesBakedMesh"],
    ],
  ],
  [
    "Acceleration",
    [
      ["X1", "list", "`accelerator`: `list`", "", "Accelerators.MatchesListOnRandomShapes"],
      ["X2", "box per object", "`boxes`", "", "Accelerators.MatchesListOnRandomShapes"],
      ["X3", "oriented box per object", "`oriented-boxes`", "", "OrientedBox.EnclosesItsHull"],
      [
        "X4",
        "bounding volume hierarchies",
        "`bvh`, `bottom-up`, `obb-tree`",
        "",
        "SurfaceAreaHeuristic.StaysNearBottomUpTestCount",
      ],
      ["X5", "uniform grid", "`grid`", "", "GridLayouts.VisitsExactlyTouchedCells"],
      ["X6", "octree", "`octree`", "", "Partitions.HitsSheetsOnSplitPlanes"],
      ["X7", "kd-tree", "`kd-median`, `kd-sah`", "", "Partitions.ReturnsNearerOfLongAndShortPrimitives"],
      ["X8", "adaptive partition", "`adaptive-grid`", "", "AdaptiveGrid.NeedsFewTestsForSmallMeshInLargeScene"],
      ["X9", "ray reordering", "`ray_sorting`", "", "Reordering.PreservesHitsAndShadows"],
      [
        "X10",
        "learned prediction",
        "`occluder_prediction`: `network`",
        "",
        "ShadowPrediction.PreservesShadowsOfEveryStructure",
      ],
      ["X12", "dynamic scenes", "`motion`", "open-shutter", "Motion.RefitsOrRebuildsForSwappingInstances"],
      ["X13", "costs", "`--stats`", "", "Stages.CountsDeterministically"],
    ],
  ],
  [
    "Camera and motion",
    [
      [
        "C",
        "perspective, orthographic, panorama",
        "`perspective`, `orthographic`, `panorama`",
        "camera-orthographic, panorama",
        "CameraRays.ScalesBothAxesByHeight, CameraRays.SpacesPanoramaAnglesEvenly",
      ],
      [
        "C",
        "thin lens, shutter",
        "`aperture_radius`, `shutter`",
        "depth-of-field, open-shutter",
        "ThinLens.BlursPointToDiskOfExpectedRadius, Shutter.BlursMovingSquareToTrapezoid",
      ],
      ["C", "orbit", "`azimuth_degrees`, `elevation_degrees`", "orrery", "Orbit.MatchesRotationFormula"],
      ["C", "keyframed objects", "`motion`", "flag", "Motion.MatchesStaticSceneAtEachTime"],
    ],
  ],
  [
    "Service",
    [
      ["V", "image of a posted scene", "`POST /v1/render`", "", "FramePng.ReturnsImmutablePng"],
      [
        "V",
        "scene store, frames by angle",
        "`POST /v1/scenes`, `GET /v1/scenes/{id}/frame.png`",
        "",
        "FramePng.ReturnsEqualBytesForEqualUrls",
      ],
      ["V", "orbit stream and page", "`GET /v1/scenes/{id}/orbit`", "", "OrbitStream.MatchesImagesOfSameAngle"],
      ["V", "jobs", "`POST /v1/jobs`", "", "JobTest.RendersOrbitAndReportsEveryFrame"],
      ["V", "explain", "`GET /v1/scenes/{id}/explain`", "", "Scenes.ExplainsDecisionsForQuery"],
      [
        "V",
        "chart of speed against accuracy",
        "`POST /v1/scenes/{id}/charts`",
        "",
        "Study.MatchesIndependentMeasurement",
      ],
      [
        "V",
        "budgets",
        "`max_error`, `time_limit_seconds`",
        "",
        "ErrorBudget.MeetsReportedError, TimeBudget.EndsInTimeWithWholePasses",
      ],
    ],
  ],
  [
    "Faults of the sources, not repeated",
    [
      ["1", "cylinder roots divided by A instead of 2A", "`cylinder`", "", "Cylinder.DividesRootsByTwiceA"],
      ["2", "origin as the mark of an infinite cylinder", "`cylinder`", "", "Cylinder.TreatsOriginAsOrdinaryCapCentre"],
      ["3", "light direction of length sqrt 3", "`direction_to_light`", "", "Directional.NormalizesDirection"],
      ["4", "one fixed epsilon", "", "", "RandomScenes.IsScaleInvariant, SecondaryRays.AvoidsSelfIntersectionInFloat"],
      ["5", "outside normal inside glass", "`refractive`", "", "Slab.ShiftsRayWithoutChangingDirection"],
      ["6", "energy lost at total reflection", "`refractive`", "", "Refraction.ReflectsTotallyBeyondCriticalAngle"],
      ["7", "power of a negative cosine", "`fresnel`", "", "Fresnel.CreatesNoLightForBackfacingNormals"],
      ["8", "no aspect ratio", "`image`", "", "Coverage.KeepsBallsRoundInAnyAspect"],
      [
        "9",
        "slab test with NaN, kd-tree that visits one child",
        "`accelerator`",
        "",
        "Accelerators.MatchesListOnGrazingRays, Partitions.HitsSheetsOnSplitPlanes",
      ],
      ["10", "growth of the ray count", "", "", "RayTree.GrowsWithBranchesButNotWithObjects"],
    ],
  ],
];

const listOf = (text) => text.split(", ").filter(Boolean);

function* filesIn(folder) {
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) yield* filesIn(path);
    else yield path;
  }
}

// Returns the test of each name "Suite.Name", as a path relative to the root.
export function findTests(root = kRoot) {
  const places = new Map();
  for (const path of filesIn(join(root, "tests"))) {
    if (!path.endsWith(".cpp")) continue;
    for (const [, suite, name] of readFileSync(path, "utf8").matchAll(/^(?:TYPED_)?TEST(?:_[FP])?\((\w+), (\w+)\)/gm))
      places.set(`${suite}.${name}`, path.slice(root.length + 1));
  }
  return places;
}

// Returns docs/systems.md.
export function drawSystems(tests = findTests()) {
  const lines = [
    "# Systems",
    "",
    "Each row is a system of the three sources: how to reach it, a sample scene and a test that fails without it.",
    "`node tests/lint/systems.mjs > docs/systems.md` writes this file. The test `lint.systems` checks that keys, scenes",
    "and tests exist.",
  ];
  for (const [title, rows] of kGroups) {
    lines.push("", `## ${title}`, "", "| id | system | reach it by | sample | test |", "|---|---|---|---|---|");
    for (const [id, system, reach, samples, names] of rows) {
      const scenes = listOf(samples).map((name) => `[${name}](../scenes/${name}.json)`);
      const links = listOf(names).map((name) => `[${name}](../${tests.get(name) ?? "?"})`);
      lines.push(`| ${id} | ${system} | ${reach} | ${scenes.join(", ")} | ${links.join(", ")} |`);
    }
  }
  return `${lines.join("\n")}\n`;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) process.stdout.write(drawSystems());
