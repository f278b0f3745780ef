// Opens every page of the site of the documents, at two widths.
//
//   node test/site.mjs SITE FOLDER     FOLDER gets screenshots of some pages
//
// A page fails if it says anything on the console, asks for anything by network, is wider than the screen, or leaves a formula unset.

import {chromium} from "playwright-core";
import {readdirSync} from "node:fs";
import {basename, join, resolve} from "node:path";

const [site, folder] = process.argv.slice(2);
const sizes = [["desktop", 1280, 800], ["phone", 390, 844]];
const kept = new Set(["README.html", "index.html", "gallery.html", "theory.html", "keys.html", "speed.html", "peers.html", "quickstart.html"]);
const reports = /gallery\/(?!gallery|checks)[^/]*\.html$/; // opened by open.mjs

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox"],
});
let failures = 0;
const pages = readdirSync(site, {recursive: true}).filter((name) => name.endsWith(".html") && name !== "404.html" && !reports.test(name)).sort();
for (const [size, width, height] of sizes) {
  const page = await browser.newPage({viewport: {width, height}});
  let now = "";
  const fail = (what) => { ++failures; console.error(`  FAIL ${now}, ${size}: ${what}`); };
  page.on("console", (message) => { if (message.type() === "error" && !/CORS|file:\/\/\/.*search/.test(message.text())) fail(`the console says: ${message.text()}`); });
  page.on("pageerror", (error) => fail(`an error: ${error.message}`));
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) fail(`it asks for ${request.url()}`); });
  for (now of pages) {
    await page.goto(`file://${resolve(join(site, now))}`);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    if (wide > 0) fail(`${wide} pixels too wide`);
    const unset = await page.evaluate(() => document.querySelectorAll(".katex-error").length);
    if (unset > 0) fail(`${unset} formulas are not set`);
    if (kept.has(basename(now))) await page.screenshot({path: join(folder, `site-${basename(now, ".html")}-${size}.png`)});
  }
  await page.close();
}
console.log(`${pages.length} pages of the site at ${sizes.length} widths`);
await browser.close();
process.exit(failures === 0 && pages.length > 0 ? 0 : 1);
