// Opens every page of the site of the documents, at two widths.
//
//   node test/site.mjs SITE FOLDER     FOLDER gets screenshots of some pages
//
// They are read from a server on this machine, as search needs one; one page is opened as a file, too.
//
// A page fails if it says anything on the console, asks for anything by network, is wider than the screen, or leaves a formula unset.

import {chromium} from "playwright-core";
import {readdirSync, readFileSync} from "node:fs";
import {createServer} from "node:http";
import {basename, extname, join, resolve} from "node:path";

const [site, folder] = process.argv.slice(2);
const sizes = [["desktop", 1280, 800], ["phone", 390, 844]];
const kept = new Set(["README.html", "index.html", "gallery.html", "theory.html", "keys.html", "speed.html", "peers.html", "quickstart.html"]);
const reports = /gallery\/(?!gallery|checks)[^/]*\.html$/; // opened by open.mjs

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox"],
});
const types = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".json": "application/json", ".svg": "image/svg+xml"};
const server = createServer((request, response) => {
  const path = join(resolve(site), decodeURIComponent(new URL(request.url, "http://here").pathname));
  try {
    response.setHeader("Content-Type", types[extname(path)] ?? "application/octet-stream");
    response.end(readFileSync(path));
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const origin = `http://127.0.0.1:${server.address().port}`;

let failures = 0;
const pages = readdirSync(site, {recursive: true}).filter((name) => name.endsWith(".html") && name !== "404.html" && !reports.test(name)).sort();
for (const [size, width, height] of sizes) {
  const page = await browser.newPage({viewport: {width, height}});
  let now = "";
  const fail = (what) => { ++failures; console.error(`  FAIL ${now}, ${size}: ${what}`); };
  page.on("console", (message) => { if (message.type() === "error") fail(`the console says: ${message.text()}`); });
  page.on("pageerror", (error) => fail(`an error: ${error.message}`));
  page.on("request", (request) => { if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(origin)) fail(`it asks for ${request.url()}`); });
  for (now of pages) {
    await page.goto(`${origin}/${encodeURI(now)}`);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    if (wide > 0) fail(`${wide} pixels too wide`);
    const unset = await page.evaluate(() => document.querySelectorAll(".katex-error").length);
    if (unset > 0) fail(`${unset} formulas are not set`);
    if (kept.has(basename(now))) await page.screenshot({path: join(folder, `site-${basename(now, ".html")}-${size}.png`)});
  }
  if (size === "desktop") {
    now = "search";
    await page.goto(`${origin}/index.html`);
    await page.locator(".md-search__input").fill("servo");
    const found = page.locator(".md-search-result__link").first();
    await found.waitFor({timeout: 30_000}).catch(() => fail("search finds nothing about servos"));
  }
  await page.close();
}
const page = await browser.newPage();
await page.goto(`file://${resolve(join(site, "index.html"))}`);
if ((await page.locator("h1").first().textContent()).trim() === "") { ++failures; console.error("  FAIL index.html as a file has no heading"); }
server.close();
console.log(`${pages.length} pages of the site at ${sizes.length} widths`);
await browser.close();
process.exit(failures === 0 && pages.length > 0 ? 0 : 1);
