// Loader of page modules for tests without a browser.

import { cpSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after } from "node:test";
import { kRoot } from "./support.mjs";

// Copy of web/ marked as modules, which Node requires and a browser does not.
const copy = mkdtempSync(join(tmpdir(), "orrery-web-"));
cpSync(join(kRoot, "web"), copy, { recursive: true });
writeFileSync(join(copy, "package.json"), '{"type": "module"}');
after(() => rmSync(copy, { recursive: true }));

export const load = (name) => import(join(copy, name));
