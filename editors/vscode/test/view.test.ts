import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterEach, beforeEach, describe, expect, test, vi } from "vitest";
import { View } from "../src/page/view.js";
import { Views } from "../src/page/views.js";
import { moduleOf } from "../src/server/command.js";
import { PYTHON } from "./program.js";

let folder: string;
beforeEach(() => {
  folder = mkdtempSync(join(tmpdir(), "linkwright-vscode-"));
  vi.stubEnv("XDG_STATE_HOME", join(folder, "state"));
  vi.stubEnv("ROS_LOG_DIR", join(folder, "log"));
});
afterEach(() => {
  vi.unstubAllEnvs();
  rmSync(folder, { recursive: true });
});

test("a program that is not there is told where the address is asked for", async () => {
  const view = new View(moduleOf(join(folder, "python")), join(folder, "arm.urdf"), folder, () => undefined);
  await expect(view.address).rejects.toThrow("ENOENT");
});

describe.skipIf(PYTHON === undefined)("the real program", () => {
  const command = moduleOf(PYTHON ?? "");

  test("serves the page, once for each file, until it is stopped", async () => {
    const file = join(folder, "arm.urdf");
    writeFileSync(file, '<robot name="arm"><link name="base"/></robot>\n');
    const views = new Views(() => undefined);
    const address = await views.address(command, file, folder);
    expect(await views.address(command, file, folder)).toBe(address);
    const answer = await fetch(address);
    expect(answer.status).toBe(200);
    // Why the page is not shown in a webview or in the Simple Browser, which put it into a frame:
    expect(answer.headers.get("Content-Security-Policy")).toContain("frame-ancestors 'none'");
    views.dispose();
    await expect.poll(() => fetch(address).then(() => "served", () => "gone"), { timeout: 20_000 }).toBe("gone");
  });

  test("ends with a file that is not there, and its output says why", async () => {
    let printed = "";
    const view = new View(command, join(folder, "none.urdf"), folder, (line) => (printed += line));
    await expect(view.address).rejects.toThrow("ended with status 1");
    expect(printed).toContain("no such file");
  });
});
