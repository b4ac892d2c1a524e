#!/usr/bin/env node
// Links that cannot be shown: the page names the error and offers a way out.

import assert from "node:assert/strict";
import { after } from "node:test";
import { axe_violations, hash_of, page_tests, rest, start_both } from "./support.mjs";

const { daemon, browser } = await start_both(after);
const page_test = page_tests(browser, daemon);

const refused = { ready: "#stage-problem", expected: /status of (404|422)/ };
const card_of = (page) => page.locator("#stage-problem");
const button = (page, name) => card_of(page).getByRole("button", { name });
const forgotten = "0".repeat(64);

for (const [scene, name] of [["nosuch", "nosuch"], [forgotten, "000000000000…"]]) {
  page_test(
    `a link to an unknown scene, ${name}, offers samples and pasting`,
    `scene=${scene}&samples=1&playing=0`,
    async (page) => {
      assert.match(await card_of(page).textContent(), new RegExp(`There is no scene “${name}”`));
      assert.equal(await page.locator("#hint").isVisible(), false);
      assert.equal(await page.locator("#canvas").isVisible(), false);
      assert.deepEqual(await axe_violations(page), []);

      await button(page, "Paste a scene").click();
      assert.equal(await page.locator("#text").evaluate((text) => text === document.activeElement), true);
      await button(page, "Choose a sample").focus();
      await page.keyboard.press("Enter");
      const option = page.locator("#gallery [role=option]:focus");
      assert.equal(await option.getAttribute("data-name"), "paper");
      await page.keyboard.press("Enter");
      await rest(page);
      assert.equal(await card_of(page).isVisible(), false);
      assert.equal((await hash_of(page)).scene, "paper");
    },
    refused,
  );
}

page_test(
  "a scene is pasted where a link led nowhere",
  "scene=nosuch&samples=1&playing=0",
  async (page) => {
    const text = await (await fetch(`${daemon.url}scenes/glass.json`)).text();
    await button(page, "Paste a scene").click();
    await page.keyboard.insertText(text);
    await page.keyboard.press("Control+Enter");
    await rest(page);
    assert.equal(await card_of(page).isVisible(), false);
    assert.match(await page.title(), /^Glass/);
  },
  refused,
);

page_test(
  "an unknown scene does not keep the picture of the one before",
  "playing=0",
  async (page) => {
    await rest(page);
    await page.evaluate(() => (location.hash = "scene=nosuch"));
    await card_of(page).waitFor({ state: "visible" });
    assert.equal(await page.locator("#canvas").isVisible(), false);
    assert.equal(await page.title(), "orrery");
    await page.goBack();
    await rest(page);
    assert.equal(await card_of(page).isVisible(), false);
    assert.equal(await page.locator("#canvas").isVisible(), true);
  },
  { expected: /status of 404/ },
);

for (const playing of [0, 1]) {
  for (const [setting, words, action] of [
    ["technique=xx", /technique.*got "xx"/, "Use the scene’s own technique"],
    ["samples=65000", /samples.*got 65000/, "Choose samples automatically"],
  ]) {
    if (playing === 0 && setting.startsWith("samples")) continue; // a picture at rest stays within the limit
    const [key] = setting.split("=");
    page_test(
      `a link that asks for ${setting}, playing=${playing}, offers the usual ${key}`,
      `scene=paper&${setting}&playing=${playing}`,
      async (page) => {
        assert.match(await card_of(page).textContent(), words);
        assert.equal(await page.locator("#hint").isVisible(), false);
        await button(page, action).click();
        await page.locator("#canvas").waitFor({ state: "visible" });
        assert.equal(await card_of(page).isVisible(), false);
        assert.equal((await hash_of(page))[key], undefined);
      },
      refused,
    );
  }
}

page_test(
  "a sample that is chosen instead is not refused for the link's settings",
  "technique=xx&playing=0&samples=1",
  async (page) => {
    await button(page, "Choose a sample").click();
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("Enter");
    await rest(page);
    assert.equal(await card_of(page).isVisible(), false);
    const { scene, technique, samples } = await hash_of(page);
    assert.deepEqual([scene, technique, samples], ["cornell-box", undefined, "1"], "only what was refused is dropped");
  },
  refused,
);

page_test("a link from below the floor opens above it", "scene=mirrors&el=-80&playing=0", async (page) => {
  await rest(page);
  const lowest = Number((await hash_of(page)).el);
  assert.ok(lowest > -30 && lowest < 0, `${lowest} degrees`);
  await page.locator('[data-do="down"]').click();
  await rest(page);
  assert.equal(Number((await hash_of(page)).el), lowest);
});
