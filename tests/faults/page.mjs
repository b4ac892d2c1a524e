// Mistakes of the page's modules, as faults.mjs has them: fault 26.

const entry = (about, file, from, to, ...tests) => ({
  fault: 26, about, file: `web/${file}`, from, to, target: "tests/browser/modules.test.mjs", tests,
});

export const pageFaults = [
  entry("lengths in a stream are read in the machine's byte order", "stream.js", "getUint32(0)", "getUint32(0, true)",
        "frames come out whole however the bytes are cut"),
  entry("what follows a frame in its chunk is dropped", "stream.js", "this.#chunks[0] = first.subarray(count);",
        "this.#chunks[0] = new Uint8Array(first.length - count);", "frames come out whole however the bytes are cut"),
  entry("equal views have different addresses", "urls.js", "azimuth: round(picture.azimuth, 2)", "azimuth: picture.azimuth",
        "addresses are the same for the same view and safe in a shell"),
  entry("a command to copy shows the token", "urls.js", "'-H \"Authorization: Bearer $ORRERY_TOKEN\" '",
        "`-H \"Authorization: Bearer ${token}\" `", "the command takes a token from the environment"),
  entry("a stream has as many pixels as a still", "size.js", 'purpose === "stream" && fills', "false",
        "a picture fits its box and the limits"),
  entry("numbers in a link have no range", "state.js", "Math.min(high, Math.max(low, value))", "value",
        "a link restores what it was made from, and nonsense in it is ignored"),
  entry("an orbit becomes a slide show", "pace.js", "Math.max(rate, Math.abs(speed) / kWidestStep)", "rate",
        "an orbit never turns into a slide show, and fast frames are left alone"),
  entry("pictures at rest get no finer than the scene's own", "quality.js", "Math.max(own, kLadder.at(-1))", "own",
        "pictures at rest get finer up to what was chosen, or what the scene asks for"),
  entry("a slash in a JSON pointer is not unescaped", "pointer.js", '.replaceAll("~1", "/")', "",
        "a JSON pointer leads to its place in the text"),
];
