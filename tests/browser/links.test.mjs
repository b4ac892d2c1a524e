#!/usr/bin/env node
// Tests links that cannot be shown: the page must name the error and offer alternatives.

import assert from "node:assert/strict";
import { after } from "node:test";
import { axeViolations, hashOf, pageTests, rest, startBoth } from "./support.mjs";

const { daemon, browser } = await startBoth(after);
const pageTest = pageTests(browser, daemon);

const refused = { ready: "#stage-problem", expected: /status of (404|422)/ };
const cardOf = (page) => page.locator("#stage-problem");
const button = (page, name) => cardOf(page).getByRole("button", { name });
const forgotten = "0".repeat(64);

for (const [scene, name] of [
  ["nosuch", "nosuch"],
  [forgotten, "000000000000…"],
]) {
  pageTest(
    `a link to the unknown scene ${name} offers to choose a sample or paste a scene`,
    `scene=${scene}&samples=1&playing=0`,
    async (page) => {
      assert.match(await cardOf(page).textContent(), new RegExp(`Unknown scene “${name}”`));
      assert.equal(await page.locator("#hint").isVisible(), false);
      assert.equal(await page.locator("#canvas").isVisible(), false);
      assert.deepEqual(await axeViolations(page), []);

      await button(page, "Paste a scene").click();
      assert.equal(await page.locator("#text").evaluate((text) => text === document.activeElement), true);
      await button(page, "Choose a sample scene").focus();
      await page.keyboard.press("Enter");
      const option = page.locator("#gallery [role=option]:focus");
      assert.equal(await option.getAttribute("data-name"), "paper");
      await page.keyboard.press("Enter");
      await rest(page);
      assert.equal(await cardOf(page).isVisible(), false);
      assert.equal((await hashOf(page)).scene, "paper");
    },
    refused,
  );
}

pageTest(
  "a scene can be pasted after a link to an unknown scene",
  "scene=nosuch&samples=1&playing=0",
  async (page) => {
    const text = await (await fetch(`${daemon.url}scenes/glass.json`)).text();
    await button(page, "Paste a scene").click();
    await page.keyboard.insertText(text);
    await page.keyboard.press("Control+Enter");
    await rest(page);
    assert.equal(await cardOf(page).isVisible(), false);
    assert.match(await page.title(), /^Glass/);
  },
  refused,
);

pageTest(
  "a link to an unknown scene clears the previous image",
  "playing=0",
  async (page) => {
    await rest(page);
    await page.evaluate(() => (location.hash = "scene=nosuch"));
    await cardOf(page).waitFor({ state: "visible" });
    assert.equal(await page.locator("#canvas").isVisible(), false);
    assert.equal(await page.title(), "orrery");
    await page.goBack();
    await rest(page);
    assert.equal(await cardOf(page).isVisible(), false);
    assert.equal(await page.locator("#canvas").isVisible(), true);
  },
  { expected: /status of 404/ },
);

for (const playing of [0, 1]) {
  for (const [setting, words, action] of [
    ["technique=xx", /technique.*got "xx"/, "Use the scene’s technique"],
    ["samples=65000", /samples.*got 65000/, "Choose samples automatically"],
  ]) {
    if (playing === 0 && setting.startsWith("samples")) continue; // a still image stays within the limit
    const [key] = setting.split("=");
    pageTest(
      `a rejected link with ${setting}, playing=${playing}, offers to reset ${key}`,
      `scene=paper&${setting}&playing=${playing}`,
      async (page) => {
        assert.match(await cardOf(page).textContent(), words);
        assert.equal(await page.locator("#hint").isVisible(), false);
        await button(page, action).click();
        await page.locator("#canvas").waitFor({ state: "visible" });
        assert.equal(await cardOf(page).isVisible(), false);
        assert.equal((await hashOf(page))[key], undefined);
      },
      refused,
    );
  }
}

pageTest(
  "choosing a sample drops only the rejected settings of the link",
  "technique=xx&playing=0&samples=1",
  async (page) => {
    await button(page, "Choose a sample scene").click();
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("Enter");
    await rest(page);
    assert.equal(await cardOf(page).isVisible(), false);
    const { scene, technique, samples } = await hashOf(page);
    assert.deepEqual(
      [scene, technique, samples],
      ["atmosphere-depth-cue", undefined, "1"],
      "only the rejected setting is dropped",
    );
  },
  refused,
);

pageTest("a link to a view below the floor opens above the floor", "scene=mirrors&el=-80&playing=0", async (page) => {
  await rest(page);
  const lowest = Number((await hashOf(page)).el);
  assert.ok(lowest > -30 && lowest < 0, `${lowest} degrees`);
  await page.locator('[data-do="down"]').click();
  await rest(page);
  assert.equal(Number((await hashOf(page)).el), lowest);
});
