import { expect, test } from "vitest";
import { candidates, type Places, resolved } from "../src/server/candidates.js";
import { type Command, shown } from "../src/server/command.js";
import { findServer, installable } from "../src/server/finder.js";
import { emptyPlaces } from "./places.js";

const EVERYWHERE = {
  exists: () => true,
  selectedPython: () => Promise.resolve("/conda/bin/python"),
  onPath: (program: string) => `/usr/bin/${program}`,
};

async function order(given: Partial<Places>): Promise<string[]> {
  const commands: string[] = [];
  for await (const { command } of candidates(emptyPlaces(given))) commands.push(shown(command));
  return commands;
}

function only(program: string): (command: Command) => Promise<string | undefined> {
  return (command) => Promise.resolve(command.program === program ? undefined : "no Linkwright");
}

test("the workspace's environments come before the selected Python, and the PATH comes last", async () => {
  expect(await order(EVERYWHERE)).toEqual([
    "/work/.venv/bin/python -m linkwright",
    "/work/venv/bin/python -m linkwright",
    "/conda/bin/python -m linkwright",
    "/usr/bin/linkwright",
  ]);
});

test("each folder of the workspace may have an environment", async () => {
  const exists = (file: string): boolean => file.startsWith("/two/");
  expect(await order({ folders: ["/one", "/two"], exists })).toEqual([
    "/two/.venv/bin/python -m linkwright",
    "/two/venv/bin/python -m linkwright",
  ]);
});

test("an interpreter that is set is the only one tried", async () => {
  expect(await order({ ...EVERYWHERE, interpreter: "/opt/python" })).toEqual(["/opt/python -m linkwright"]);
});

test("environments on Windows have their Python in Scripts", async () => {
  const exists = (file: string): boolean => file === "C:\\robot\\.venv\\Scripts\\python.exe";
  expect(await order({ folders: ["C:\\robot"], isWindows: true, exists })).toEqual([
    "C:\\robot\\.venv\\Scripts\\python.exe -m linkwright",
  ]);
});

test.each([
  ["/opt/python", "/opt/python"],
  ["${workspaceFolder}/.venv/bin/python", "/work/.venv/bin/python"],
  [".venv/bin/python", "/work/.venv/bin/python"],
  ["~/robot/bin/python", "/home/me/robot/bin/python"],
  [" python3.12 ", "python3.12"],
])("the setting %s means %s", (setting, path) => {
  expect(resolved(setting, emptyPlaces())).toBe(path);
});

test("the first command that runs the server is found, and what failed before is told", async () => {
  const search = await findServer(emptyPlaces(EVERYWHERE), only("/conda/bin/python"));
  expect(search.found?.command.program).toBe("/conda/bin/python");
  expect(search.failures.map(({ candidate, reason }) => [candidate.command.program, reason])).toEqual([
    ["/work/.venv/bin/python", "no Linkwright"],
    ["/work/venv/bin/python", "no Linkwright"],
  ]);
});

test("the Python extension is not asked where an environment has the server", async () => {
  let isAsked = false;
  const selectedPython = (): Promise<undefined> => {
    isAsked = true;
    return Promise.resolve(undefined);
  };
  await findServer(emptyPlaces({ ...EVERYWHERE, selectedPython }), only("/work/.venv/bin/python"));
  expect(isAsked).toBe(false);
});

test("Linkwright is installed into the preferred interpreter", async () => {
  const search = await findServer(emptyPlaces({ ...EVERYWHERE, exists: () => false }), only("none"));
  expect(search.found).toBeUndefined();
  expect(installable(search)).toBe("/conda/bin/python");
});

test("nothing is installed beside a linkwright on the PATH, which another program manages", async () => {
  const search = await findServer(emptyPlaces({ onPath: EVERYWHERE.onPath }), only("none"));
  expect(search.failures).toHaveLength(1);
  expect(installable(search)).toBeUndefined();
});
