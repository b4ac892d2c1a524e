// Which translation units see a fault in a header that most include, so that a check compiles those alone instead of
// all: by header and by what runs the tests, beginnings of their paths.
const unitsByHeader = {
  "core/base/work_scope.h": {test_app: ["core/base/work_scope.cpp"]},
  "core/math/affine.h": {test_meshes: ["core/meshes/gltf"]},
  "core/math/bounds.h": {test_accelerators: ["core/accelerators/"], test_math: ["tests/math/"]},
  "core/math/hemisphere.h": {test_math: ["tests/math/"], test_stability: ["core/stability/tangent_frame.cpp"]},
  "core/math/keys.h": {
    test_accelerators: ["core/accelerators/moving_instances.cpp", "core/shapes/mesh.cpp"],
    test_render: ["core/model/", "core/prepare/", "core/shapes/"],
  },
  "core/math/sampling.h": {test_stability: ["core/stability/"]},
  "core/math/vec3.h": {test_stability: ["core/stability/unit_vector.cpp"]},
  "core/model/bound.h": {test_render: ["core/render/certificate.cpp"]},
  "core/model/draws.h": {test_render: ["core/render/tile_renderer.cpp"]},
  "core/model/radiance_range.h": {test_render: ["core/plan/plan.cpp"]},
  "core/stability/row.h": {test_stability: ["core/stability/report.cpp", "tests/stability/"]},
  "server/app/orbit.h": {test_http: ["server/app/orbit_budget.cpp"]},
  "server/app/render_services.h": {test_app: ["server/app/", "tests/app/"]},
  "server/app/single_flight.h": {test_app: ["tests/app/"]},
};

// Undefined: all that include the file.
export const unitsWith = ({file, target}) => unitsByHeader[file]?.[target];
