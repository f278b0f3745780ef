// Marks of logarithmic axes: all of them, in order, and an end to them wherever the axis begins.
import assert from "node:assert/strict";
import {aboveNoise, logMarks, withUnit} from "../src/format.js";

assert.deepEqual(logMarks(0.85, 30), [0.9, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 20, 30]);
assert.deepEqual(logMarks(0.2, 0.5), [0.2, 0.3, 0.4, 0.5]);
// The share of one element in a block of a million: uPlot's own marks do not end there.
const marks = logMarks(9.8648434117105963e-07, 0.98);
assert.equal(marks.length, 6 * 9);
assert.equal(marks[0], 1e-6);
assert.equal(marks.at(-1), 0.9);
for (let power = -12; power < 6; ++power)
  for (const low of [1.1, 3.7, 9.99]) assert.ok(logMarks(low * 10 ** power, 7 * 10 ** (power + 4)).length <= 45);
console.log("marks of logarithmic axes end");

// Plastic energy of a run without any, beside a work of 2 J.
assert.equal(withUnit(aboveNoise(-5.42e-22, 2), "J", 3), "0 J");
assert.equal(aboveNoise(3e-6, 2), 3e-6);
