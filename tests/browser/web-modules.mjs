// Loader of page modules for tests without a browser.

import { join } from "node:path";
import { ROOT } from "./support.mjs";

export const load = (name) => import(join(ROOT, "web", name));
