// The translation units to compile for a fault in a header that most units include. Keys are the header and the test
// executable, values are prefixes of paths.
const unitsByHeader = {
  "core/math/bounds.h": { test_math: ["tests/math/"] },
  "core/math/sampling.h": { test_stability: ["core/stability/"] },
  "core/model/bound.h": { test_render: ["core/accuracy/certificate.cpp"] },
  "core/stability/row.h": { test_stability: ["core/stability/report.cpp", "tests/stability/"] },
  "server/cache/single_flight.h": { test_server: ["tests/server/"] },
};

// Returns undefined if all units that include the file are to be compiled.
export const unitsWith = ({ file, target }) => unitsByHeader[file]?.[target];
