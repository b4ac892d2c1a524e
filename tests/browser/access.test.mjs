#!/usr/bin/env node
// Service with a token, simulated by rejecting requests without one.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, test } from "node:test";
import { axe_violations, eventually, rest, start_both } from "./support.mjs";

const { daemon, browser } = await start_both(after);

const kToken = "correct-horse";
const kHash = "#scene=paper&playing=0&samples=1&az=20";

// Opens the page and rejects its requests to v1 without the token. `refused` and `passed` list their paths.
async function guarded_page(options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  const refused = [];
  const passed = [];
  await page.route("**/v1/**", async (route) => {
    const { pathname } = new URL(route.request().url());
    const authorized = (await route.request().headerValue("authorization")) === `Bearer ${kToken}`;
    (authorized ? passed : refused).push(pathname);
    if (authorized) return route.continue();
    const problem = { status: 401, title: "A token is needed", detail: "Send one.", request_id: "r1" };
    const headers = { "WWW-Authenticate": "Bearer" };
    return route.fulfill({ status: 401, headers, contentType: "application/problem+json", json: problem });
  });
  await page.goto(daemon.url + kHash);
  return { page, refused, passed, close: () => page.unrouteAll({ behavior: "ignoreErrors" }).then(() => context.close()) };
}

async function enter(page, token) {
  await page.getByLabel("Token", { exact: true }).fill(token);
  await page.keyboard.press("Enter");
}

test("the page asks for a token once, and every request carries it", async () => {
  const { page, refused, passed, close } = await guarded_page({ permissions: ["clipboard-read", "clipboard-write"] });
  const form = page.getByRole("dialog", { name: /asks for a token/ });
  await form.waitFor();
  assert.equal(await page.getByLabel("Token", { exact: true }).getAttribute("type"), "password");
  await enter(page, "wrong");
  await eventually("a refusal", async () => /did not accept/.test(await form.textContent()));
  await enter(page, kToken);
  await rest(page);
  assert.equal(await form.isVisible(), false);
  await page.locator(".thumbnail").first().waitFor();
  assert.deepEqual(new Set(refused), new Set(["/v1/catalog", "/v1/limits"]));
  assert.ok(passed.some((path) => path.endsWith("/frame.png")));

  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#download").click()]);
  assert.match(download.url(), /^blob:/, "a link of its own would carry no token");
  assert.equal(download.suggestedFilename(), "paper-20-0.png");
  assert.equal(readFileSync(await download.path()).toString("latin1", 1, 4), "PNG");
  await page.locator("#curl").click();
  await eventually("the command", async () =>
    /^curl -fo \S+ -H "Authorization: Bearer \$ORRERY_TOKEN" 'http/.test(
      await page.evaluate(() => navigator.clipboard.readText()),
    ),
  );

  await page.locator("#play").click();
  await page.locator('#stage[data-shows="stream"]').waitFor();
  await page.reload();
  await page.locator("#stage[data-shows]").waitFor();
  assert.equal(await form.isVisible(), false, "the tab keeps the token");
  assert.equal(refused.length, 4, "two were refused twice");
  assert.ok(!(await page.content()).includes(kToken) && !page.url().includes(kToken));
  await close();
});

test("who closes the form sees what the service said", async () => {
  const { page, close } = await guarded_page();
  await page.getByRole("dialog").waitFor();
  await page.keyboard.press("Escape");
  await page.locator("#stage-problem").waitFor({ state: "visible" });
  assert.match(await page.locator("#stage-problem").textContent(), /A token is needed/);
  await close();
});

for (const colorScheme of ["light", "dark"]) {
  test(`axe finds nothing to fault in the form, ${colorScheme}`, async () => {
    const { page, close } = await guarded_page({ colorScheme, viewport: { width: 360, height: 740 } });
    await page.getByRole("dialog").waitFor();
    await enter(page, "wrong");
    await page.getByText("did not accept").waitFor();
    assert.deepEqual(await axe_violations(page), []);
    await close();
  });
}
