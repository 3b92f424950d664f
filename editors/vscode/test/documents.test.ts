import { expect, test } from "vitest";
import { isRosManifest } from "../src/server/documents.js";

test.each([
  ['<?xml version="1.0"?>\n<package format="3">\n  <name>arm</name>', true],
  ["<package>\n  <name>arm</name>", true],
  ['<?xml version="1.0"?>\n<Package xmlns="http://soap.sforce.com/2006/04/metadata">', false],
  ['<package packagerversion="1.9.1" version="2.0" xmlns="http://pear.php.net/dtd/package-2.0">', false],
  ["", false],
])("%s", (text, isRos) => {
  expect(isRosManifest(text)).toBe(isRos);
});
