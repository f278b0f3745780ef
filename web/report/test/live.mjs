// Opens the page of `breccia watch --serve` and waits for it to show more frames, with the reader's choices kept.
//
//   node test/live.mjs ADDRESS SCREENSHOT.png

import {chromium} from "playwright-core";

const [address, picture] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const page = await browser.newPage({viewport: {width: 1280, height: 800}});
page.setDefaultTimeout(120_000);
let failures = 0;
const fail = (what) => { ++failures; console.error(`  FAIL ${what}`); };
page.on("console", (message) => fail(`the console says: ${message.text()}`));
page.on("pageerror", (error) => fail(`an error: ${error.message}`));
page.on("request", (request) => { if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(new URL(address).origin)) fail(`it asks for ${request.url()}`); });

const ready = () => page.waitForFunction(() => document.documentElement.dataset.ready === "true");
const frames = () => page.evaluate(() => Number(document.querySelector("input[aria-label=frame]").max) + 1);
await page.goto(address);
await ready();
const before = await frames();
const loaded = await page.evaluate(() => performance.now()); // the page looks for news after ten times as long
await page.waitForTimeout(3000); // it has asked once and seen a run that has ended
console.log("open"); // from now on the run may go on
await page.evaluate(() => {
  const pick = document.querySelector(".controls select");
  pick.value = "velocity";
  pick.dispatchEvent(new Event("change"));
});
await page.waitForFunction((n) => Number(document.querySelector("input[aria-label=frame]")?.max) + 1 > n, before, {timeout: 120_000 + 10 * loaded});
await ready();
const after = await frames();
const coloring = await page.evaluate(() => document.querySelector(".controls select").value);
if (coloring !== "velocity") fail(`colours of ${coloring}, not of velocity`);
const shown = await page.evaluate(() => Number(document.querySelector("input[aria-label=frame]").value) + 1);
if (shown !== after) fail(`frame ${shown} of ${after}, not the last`);
await page.waitForTimeout(500);
await page.screenshot({path: picture});
console.log(`${before} frames, then ${after}`);
await browser.close();
process.exit(failures ? 1 : 0);
