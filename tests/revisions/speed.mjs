#!/usr/bin/env node
// Compares the speed of this tree's build with another revision's, built by compare.sh. Runs alternate, and
// the result is the ratio of the medians.
//   node tests/revisions/speed.mjs REVISION [--rounds N] [--only WORD]

import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync } from "node:fs";
import { spawn } from "node:child_process";
import { FrameReader, cpuSeconds, postScene, send } from "../bench/daemon.mjs";
import { startTwoSided } from "../bench/two_sided.mjs";

const FLAKE = "build/bench-scenes/sphereflake.json"; // 7,381 spheres

function argumentsOf(words) {
  const [name, ...rest] = words;
  const options = { rounds: "7", only: "" };
  for (let i = 0; i < rest.length; i += 2) options[rest[i].replace("--", "")] = rest[i + 1];
  if (!name) throw new Error("usage: speed.mjs REVISION [--rounds N] [--only WORD]");
  const revision = execFileSync("git", ["rev-parse", "--verify", `${name}^{commit}`], { encoding: "utf8" }).trim();
  return { theirs: `build-revision/${revision}/build`, rounds: Number(options.rounds), only: options.only };
}

// Returns CPU seconds of rendering alone, on one thread.
const render = (scene, side, more) => (build) => {
  const words = ["render", scene, "--width", side, "--height", side, "--threads", 1, "--stats=json", ...more];
  return JSON.parse(execFileSync(`${build}/orrery`, words.map(String), { encoding: "utf8" })).render_cpu_s;
};

// Returns CPU seconds of a service that streams an orbit.
const orbitHttp = (frames) => async (build) => {
  const child = spawn(`${build}/orrery`, ["serve", "--port", "0", "--health-port", "0", "--threads", "2", "--quiet"], {
    stdio: ["ignore", "pipe", "ignore"],
  });
  try {
    const port = await new Promise((resolve, reject) => {
      let text = "";
      child.stdout.on("data", (bytes) => {
        text += bytes;
        const match = /http:\/\/\S+:(\d+)/.exec(text);
        if (match) resolve(Number(match[1]));
      });
      child.once("close", () => reject(new Error(`${build}/orrery serve exited`)));
    });
    const id = await postScene(port, "scenes/paper.json");
    const before = cpuSeconds(child.pid);
    const response = await send(port, "GET", `/v1/scenes/${id}/orbit?frames=${frames}&fps=0`, {
      Accept: "application/x-orrery-frames",
    });
    let seen = 0;
    const reader = new FrameReader(() => ++seen);
    for await (const chunk of response) reader.add(chunk);
    if (seen !== frames) throw new Error(`received ${seen} of ${frames} frames`);
    return cpuSeconds(child.pid) - before;
  } finally {
    child.kill("SIGTERM");
  }
};

// Measures CPU seconds of one subject of the Embree comparison. One process per build keeps the mesh loaded.
// Requires that both revisions' build/bench have the subject.
function embreeRow(subject, place, triangles, kind) {
  const sides = new Map();
  return {
    name: `embree-${subject}-${place}-${triangles / 1000}k-${kind}`,
    async run(build) {
      if (!sides.has(build))
        sides.set(build, await startTwoSided(`${build}/bench`, [subject, String(triangles), place, "default"]));
      return (await sides.get(build).ours(kind)).cpuS;
    },
    async stop() {
      for (const side of sides.values()) await side.stop();
    },
  };
}

function rows() {
  mkdirSync("build/bench-scenes", { recursive: true });
  if (!existsSync(FLAKE)) execFileSync("node", ["scenes/generate-sphereflake.mjs", "4", FLAKE]);
  const plain = (name, run) => ({ name, run, stop: async () => {} });
  const embree = [70_000, 1_000_000].flatMap((triangles) =>
    ["ball", "cad"].flatMap((subject) =>
      ["open", "room"].flatMap((place) =>
        ["primary", "bounce", "short", "build"].map((kind) => embreeRow(subject, place, triangles, kind)),
      ),
    ),
  );
  return [
    plain("paper", render("scenes/paper.json", 1500, ["--depth", 5])),
    plain("paper-64-samples", render("scenes/paper.json", 200, ["--samples", 64])),
    plain("flake", render(FLAKE, 700, ["--depth", 5])),
    plain("instances", render("scenes/instances.json", 700, [])),
    plain("double", render("scenes/glass.json", 500, ["--precision", "double"])),
    plain("orbit-http", orbitHttp(60)),
    ...embree,
  ];
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

const { theirs, rounds, only } = argumentsOf(process.argv.slice(2));
console.log("CPU seconds of theirs over ours, medians of interleaved runs: above 1 this tree is faster\n");
for (const row of rows().filter(({ name }) => name.includes(only))) {
  const times = { build: [], [theirs]: [] };
  try {
    for (const build of ["build", theirs]) await row.run(build); // warm up
    for (let round = 0; round < rounds; ++round)
      for (const build of round % 2 ? ["build", theirs] : [theirs, "build"]) times[build].push(await row.run(build));
  } finally {
    await row.stop();
  }
  const ratios = times.build.map((ours, i) => times[theirs][i] / ours).sort((a, b) => a - b);
  const ratio = median(times[theirs]) / median(times.build);
  console.log(
    `${row.name.padEnd(22)} ${ratio.toFixed(3)}  (pairs ${ratios[0].toFixed(3)} to ${ratios.at(-1).toFixed(3)})`,
  );
}
