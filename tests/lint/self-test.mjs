// Checks a lint on small inputs, each with the rules that must fire.

// Calls `rulesOf(input)` for each [expected rules, input], prints the differences and returns their number. `show`
// turns an input into the text of an error.
export function selfTest(cases, rulesOf, show) {
  let failures = 0;
  for (const [expected, ...input] of cases) {
    const fired = rulesOf(...input).join();
    if (fired === expected) continue;
    ++failures;
    console.error(`expected [${expected}], got [${fired}] for ${show(...input)}`);
  }
  console.log(`${cases.length} inputs judged, ${failures} wrongly`);
  return failures;
}
