// Known mistakes as changes of the code. check.mjs applies them one at a time to a copy of the tree and
// expects the named tests to fail.
//
//   fault    number of the mistake; several entries can be variants of one
//   about    the mistake in a few words
//   file     path of the source; `from` occurs there exactly once and becomes `to`
//   target   the GoogleTest executable
//   tests    patterns for --gtest_filter; at least one test of each must fail
//
// The list contains the ten mistakes of textbooks, and mistakes that only a statistical test or a test under
// load can detect. Other tests need no entry: break the code once by hand and see the test fail.

import { certificateFaults } from "./certificates.mjs";
import { serviceFaults } from "./service.mjs";
import { structureFaults } from "./structures.mjs";
import { systemFaults } from "./systems.mjs";
import { textbookFaults } from "./textbook.mjs";
import { textureFaults } from "./textures.mjs";
import { transportFaults } from "./transport.mjs";

export const faults = [
  ...textbookFaults,
  ...structureFaults,
  ...transportFaults,
  ...certificateFaults,
  ...serviceFaults,
  ...systemFaults,
  ...textureFaults,
];
