import { expect, test } from "vitest";
import { installCommand } from "../src/server/requirement.js";

test("without a source, pip takes Linkwright from the package index", () => {
  expect(installCommand("/venv/bin/python", "")).toEqual({
    program: "/venv/bin/python",
    args: ["-m", "pip", "install", "linkwright[lsp]"],
  });
});

test("a checkout is installed with the same extra", () => {
  expect(installCommand("python", "/home/me/my checkout").args.at(-1)).toBe("/home/me/my checkout[lsp]");
});
