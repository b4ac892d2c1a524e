// Checks a lint with small inputs, each with the rules that it must report.

// Calls `rulesOf(...input)` for each [expected rules, ...input], prints the differences and returns their
// number. `show` returns the text for an input in an error.
export function selfTest(cases, rulesOf, show) {
  let failures = 0;
  for (const [expected, ...input] of cases) {
    const fired = rulesOf(...input).join();
    if (fired === expected) continue;
    ++failures;
    console.error(`expected [${expected}], got [${fired}] for ${show(...input)}`);
  }
  console.log(`${cases.length} inputs, ${failures} failures`);
  return failures;
}
