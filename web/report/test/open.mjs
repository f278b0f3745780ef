// Opens reports in Debian's Chromium and uses them as a reader does.
//
//   node test/open.mjs FOLDER REPORT.html...     FOLDER gets a screenshot of each at two widths
//
// A report fails if it says anything on the console, asks for anything by network, is wider than the screen, draws
// nothing, or if its view does not follow a drag along a curve.

import {chromium} from "playwright-core";
import {readFileSync, writeFileSync} from "node:fs";
import {basename, resolve} from "node:path";

const [folder, ...reports] = process.argv.slice(2);
const sizes = [["desktop", 1280, 800, "light"], ["phone", 390, 844, "dark"]];
const patience = 120_000; // software rendering on a loaded machine

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

let failures = 0;
function expect(holds, what) {
  if (holds) return;
  ++failures;
  console.error(`  FAIL ${what}`);
}

/** Share of the pixels of a view that are not its background. */
const drawn = (page, n) => page.evaluate((k) => {
  const canvas = document.querySelectorAll(".canvas canvas")[k], copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const context = copy.getContext("2d");
  context.drawImage(canvas, 0, 0);
  const {data} = context.getImageData(0, 0, copy.width, copy.height);
  let count = 0;
  for (let i = 3; i < data.length; i += 4) if (data[i] > 30) ++count;
  return count / (data.length / 4);
}, n);

/** Presses a button that is switched off, and waits for the next picture. */
async function press(page, name) {
  const button = page.getByRole("button", {name, exact: true});
  if (await button.count() === 0) return;
  await button.first().click();
  await page.waitForTimeout(300);
}

async function open(report, [name, width, height, colorScheme]) {
  const page = await browser.newPage({viewport: {width, height}, colorScheme});
  page.setDefaultTimeout(patience);
  page.on("console", (message) => expect(false, `the console says: ${message.text()}`));
  page.on("pageerror", (error) => expect(false, `an error: ${error.message}`));
  page.on("request", (request) => expect(/^(file|data|blob):/.test(request.url()) , `it asks for ${request.url()}`));
  const begin = Date.now();
  await page.goto(`file://${resolve(report)}`);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "true");
  const views = await page.locator(".canvas canvas").count();
  for (let k = 0; k < views; ++k) {
    await page.waitForFunction((n) => document.querySelectorAll(".canvas canvas")[n].width > 10, k);
    const late = Date.now() + patience;
    let share = 0; // the first picture waits for shaders to be compiled, in software
    while (share <= 0.01 && Date.now() < late) {
      await page.waitForTimeout(100);
      share = await drawn(page, k);
    }
    expect(share > 0.01, `view ${k} shows something (${(100 * share).toFixed(2)} % of its pixels)`);
  }
  const seconds = ((Date.now() - begin) / 1000).toFixed(1);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  expect(wide <= 0, `it fits the screen (${wide} pixels too wide)`);
  await page.screenshot({path: `${folder}/${basename(report, ".html")}-${name}.png`, fullPage: true, timeout: patience});

  const caption = page.locator(".caption");
  const last = await caption.textContent();
  const curve = page.locator(".chart .u-over").first();
  if (views > 0 && (await curve.count()) > 0) {
    await curve.scrollIntoViewIfNeeded();
    const box = await curve.boundingBox();
    await page.mouse.move(box.x + 0.9 * box.width, box.y + 0.5 * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height, {steps: 6});
    await page.mouse.up();
    const dragged = await caption.textContent();
    expect(dragged !== last, `the view follows a drag along a curve (${last} stays)`);
  }
  for (const button of ["x-ray", "cracks", "forces", "mesh", "supports", "walls"]) await press(page, button);
  const cut = page.getByLabel("clip");
  if ((await cut.count()) > 0) {
    const before = await drawn(page, 0);
    await press(page, "x-ray");
    await cut.selectOption("y");
    await page.waitForTimeout(500);
    expect((await drawn(page, 0)) > 0.005 && before > 0.005, "a cut leaves something to see");
    await page.evaluate(() => { navigator.clipboard.writeText = async (text) => { window.copied = text; }; });
    await press(page, "copy camera");
    expect(/^\[\[key\]\]\neye = [^]*\nclip = "y>-?[\d.]+"\n$/.test(await page.evaluate(() => window.copied)), "the camera that is copied has the cut");
  }
  for (const [name, ending] of [["save case.toml", ".toml"], ["csv", ".csv"], ["png", ".png"], ["svg", ".svg"], ["save picture", ".png"]]) {
    const button = page.getByRole("button", {name, exact: true}).first();
    if ((await button.count()) === 0) continue;
    await button.scrollIntoViewIfNeeded();
    await button.hover();
    const [saved] = await Promise.all([page.waitForEvent("download", {timeout: 20_000}).catch(() => null), button.click()]);
    expect(saved?.suggestedFilename().endsWith(ending), `"${name}" saves a file`);
    if (saved && name === "svg") {
      const text = readFileSync(await saved.path(), "utf8");
      expect(text.startsWith("<svg") && /<path d="M[^"]*L/.test(text) && /<text[^>]*>[^<]*\[/.test(text) && !/NaN|undefined/.test(text), "a curve's SVG holds its line and its axes");
      writeFileSync(`${folder}/${basename(report, ".html")}-${width}.svg`, text);
    }
    if (saved && name === "save case.toml") expect(/method = "/.test(readFileSync(await saved.path(), "utf8")), "the case that is saved is one");
  }
  for (const value of await page.getByLabel("colour", {exact: false}).first().locator("option").evaluateAll((all) => all.map((o) => o.value)))
    await page.getByLabel("colour", {exact: false}).first().selectOption(value);
  await page.waitForTimeout(300);
  console.log(`${report}, ${name}: first picture after ${seconds} s, ${views} view${views === 1 ? "" : "s"}`);
  await page.close();
}

for (const report of reports) for (const size of sizes) await open(report, size);
await browser.close();
process.exit(failures === 0 ? 0 : 1);
