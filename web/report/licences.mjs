// The notice of the libraries that the page's program holds: their licences, word for word.

import {readFileSync} from "node:fs";

const parts = ["This program holds parts of these libraries."];
for (const name of ["three", "uplot"]) {
  const {version, license} = JSON.parse(readFileSync(`node_modules/${name}/package.json`, "utf8"));
  const text = readFileSync(`node_modules/${name}/LICENSE`, "utf8").replace(/\r/g, "").trim();
  parts.push(`${name} ${version} (${license})\n\n${text}`);
}
process.stdout.write(parts.join("\n\n---\n\n").replaceAll("*/", "* /") + "\n");
