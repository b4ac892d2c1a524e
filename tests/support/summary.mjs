// Reads <folder>/test-reports of each build folder given. Prints the rows of the stability catalogue that
// passed tests cover, the failed test cases with their messages, and the numbers of passed, failed and
// skipped test cases. Exits with 1 on a failure.
//
// Each GoogleTest executable reports its own test cases. Any other ctest counts as one case. C++ tests record
// their rows with RecordProperty("stability", "A1 A2"), scripts by printing a line "stability: A1 A2".

import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";

const total = {
  passed: 0,
  failed: 0,
  skipped: 0,
};
const rows = new Set();
const failures = [];

const cases = (xml) => xml.split("<testcase ").slice(1);
const attribute = (text, name) => text.match(new RegExp(`\\b${name}="([^"]*)"`))?.[1];
const entities = {
  lt: "<",
  gt: ">",
  quot: '"',
  apos: "'",
  amp: "&",
  "#x0A": " ",
  "#10": " ",
};
const plain = (text) => text.replace(/&([#\w]+);/g, (whole, name) => entities[name] ?? whole);
const note = (text) =>
  text
    .split(/\s+/)
    .filter(Boolean)
    .forEach((row) => rows.add(row));

// Counts the cases of one GoogleTest report. Returns the number of failed cases.
function countGoogleTest(xml) {
  let failed = 0;
  for (const one of cases(xml)) {
    if (one.includes("<failure")) {
      ++failed;
      const said = plain(attribute(one.slice(one.indexOf("<failure")), "message") ?? "");
      failures.push(`${attribute(one, "classname")}.${attribute(one, "name")}: ${said.slice(0, 800)}`);
    } else if (attribute(one, "result") !== "completed") ++total.skipped;
    else {
      ++total.passed;
      for (const [, value] of one.matchAll(/<property name="stability" value="([^"]*)"/g)) note(value);
    }
  }
  total.failed += failed;
  return failed;
}

for (const folder of process.argv.slice(2)) {
  const reports = join(folder, "test-reports");
  if (!existsSync(join(reports, "ctest.xml"))) {
    ++total.failed; // ctest itself failed
    continue;
  }
  for (const one of cases(readFileSync(join(reports, "ctest.xml"), "utf8"))) {
    const status = attribute(one, "status");
    const detail = join(reports, `test_${attribute(one, "name")}.xml`);
    if (existsSync(detail)) {
      // A crash at exit fails the executable although all of its cases passed.
      if (countGoogleTest(readFileSync(detail, "utf8")) > 0 || status !== "fail") continue;
      ++total.failed;
      failures.push(`${attribute(one, "name")}: the executable failed, but none of its test cases`);
    } else if (status === "run") {
      ++total.passed;
      for (const [, value] of one.matchAll(/(?:^|>)stability: ([\w ]*)/gm)) note(value);
    } else if (status === "notrun" && /<skipped message="SKIP_/.test(one)) {
      ++total.skipped;
    } else {
      ++total.failed;
      failures.push(attribute(one, "name"));
    }
  }
}

const sorted = [...rows].sort(new Intl.Collator("en", { numeric: true }).compare);
console.log(`stability rows covered (${sorted.length}): ${sorted.join(" ")}`);
for (const failure of failures) console.log(`failed: ${failure}`);
console.log(`${total.passed} passed, ${total.failed} failed, ${total.skipped} skipped`);
process.exitCode = total.failed > 0 ? 1 : 0;
