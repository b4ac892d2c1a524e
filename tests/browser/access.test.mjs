#!/usr/bin/env node
// Tests the page against a service that requires an access token. The service is simulated: requests of the
// browser without the token get status 401.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, test } from "node:test";
import { axeViolations, eventually, rest, startBoth } from "./support.mjs";

const { daemon, browser } = await startBoth(after);

const TOKEN = "correct-horse";
const HASH = "#scene=paper&playing=0&samples=1&az=20";

// Opens the page. Its requests to v1/ get status 401 unless they contain the token. `refused` and `passed`
// list the paths of requests without and with the token.
async function guardedPage(options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  const refused = [];
  const passed = [];
  await page.route("**/v1/**", async (route) => {
    const { pathname } = new URL(route.request().url());
    const authorized = (await route.request().headerValue("authorization")) === `Bearer ${TOKEN}`;
    (authorized ? passed : refused).push(pathname);
    if (authorized) return route.continue();
    const problem = {
      status: 401,
      title: "Unauthorized",
      detail: "missing token (Authorization: Bearer)",
      request_id: "r1",
    };
    const headers = { "WWW-Authenticate": "Bearer" };
    return route.fulfill({ status: 401, headers, contentType: "application/problem+json", json: problem });
  });
  await page.goto(daemon.url + HASH);
  return {
    page,
    refused,
    passed,
    close: () => page.unrouteAll({ behavior: "ignoreErrors" }).then(() => context.close()),
  };
}

async function enter(page, token) {
  await page.getByLabel("Access token", { exact: true }).fill(token);
  await page.keyboard.press("Enter");
}

test("one form asks for the token, and the page sends it with every request", async () => {
  const { page, refused, passed, close } = await guardedPage({ permissions: ["clipboard-read", "clipboard-write"] });
  const form = page.getByRole("dialog", { name: /requires an access token/ });
  await form.waitFor();
  assert.equal(await page.getByLabel("Access token", { exact: true }).getAttribute("type"), "password");
  await enter(page, "wrong");
  await eventually("the rejection", async () => /did not accept/.test(await form.textContent()));
  await enter(page, TOKEN);
  await rest(page);
  assert.equal(await form.isVisible(), false);
  await page.locator(".thumbnail").first().waitFor();
  assert.deepEqual(new Set(refused), new Set(["/v1/catalog", "/v1/limits"]));
  assert.ok(passed.some((path) => path.endsWith("/frame.png")));

  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#download").click()]);
  assert.match(download.url(), /^blob:/, "a plain link would send no token");
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
  assert.equal(refused.length, 4, "two requests were rejected twice");
  assert.ok(!(await page.content()).includes(TOKEN) && !page.url().includes(TOKEN));
  await close();
});

test("closing the token form shows the error of the service", async () => {
  const { page, close } = await guardedPage();
  await page.getByRole("dialog").waitFor();
  await page.keyboard.press("Escape");
  await page.locator("#stage-problem").waitFor({ state: "visible" });
  assert.match(await page.locator("#stage-problem").textContent(), /missing token/);
  await close();
});

for (const colorScheme of ["light", "dark"]) {
  test(`axe reports no violation in the token form, ${colorScheme}`, async () => {
    const { page, close } = await guardedPage({ colorScheme, viewport: { width: 360, height: 740 } });
    await page.getByRole("dialog").waitFor();
    await enter(page, "wrong");
    await page.getByText("did not accept").waitFor();
    assert.deepEqual(await axeViolations(page), []);
    await close();
  });
}
