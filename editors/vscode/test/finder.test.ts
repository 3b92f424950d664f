import { expect, test } from "vitest";
import { findCandidates, type Places, resolvePath } from "../src/server/candidates.js";
import { type Command, formatCommand } from "../src/server/command.js";
import { findInstallTarget, findServer } from "../src/server/finder.js";
import { createPlaces } from "./places.js";

const EVERYWHERE = {
  exists: () => true,
  getSelectedPython: () => Promise.resolve("/conda/bin/python"),
  findOnPath: (program: string) => `/usr/bin/${program}`,
};

async function listPrograms(overrides: Partial<Places>): Promise<string[]> {
  const commands: string[] = [];
  for await (const { command } of findCandidates(createPlaces(overrides))) commands.push(formatCommand(command));
  return commands;
}

function succeedOnlyFor(program: string): (command: Command) => Promise<string | undefined> {
  return (command) => Promise.resolve(command.program === program ? undefined : "no Linkwright");
}

test("the workspace's environments come before the selected Python, and the PATH comes last", async () => {
  expect(await listPrograms(EVERYWHERE)).toEqual([
    "/work/.venv/bin/python -m linkwright",
    "/work/venv/bin/python -m linkwright",
    "/conda/bin/python -m linkwright",
    "/usr/bin/linkwright",
  ]);
});

test("each folder of the workspace may have an environment", async () => {
  const exists = (file: string): boolean => file.startsWith("/two/");
  expect(await listPrograms({ folders: ["/one", "/two"], exists })).toEqual([
    "/two/.venv/bin/python -m linkwright",
    "/two/venv/bin/python -m linkwright",
  ]);
});

test("an interpreter that is set is the only one tried", async () => {
  expect(await listPrograms({ ...EVERYWHERE, interpreter: "/opt/python" })).toEqual(["/opt/python -m linkwright"]);
});

test("environments on Windows have their Python in Scripts", async () => {
  const exists = (file: string): boolean => file === "C:\\robot\\.venv\\Scripts\\python.exe";
  expect(await listPrograms({ folders: ["C:\\robot"], isWindows: true, exists })).toEqual([
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
  expect(resolvePath(setting, createPlaces())).toBe(path);
});

test("the search returns the first command that runs the server, and the failures before it", async () => {
  const search = await findServer(createPlaces(EVERYWHERE), succeedOnlyFor("/conda/bin/python"));
  expect(search.candidate?.command.program).toBe("/conda/bin/python");
  expect(search.failures.map(({ candidate, reason }) => [candidate.command.program, reason])).toEqual([
    ["/work/.venv/bin/python", "no Linkwright"],
    ["/work/venv/bin/python", "no Linkwright"],
  ]);
});

test("the Python extension is not asked where an environment has the server", async () => {
  let isAsked = false;
  const getSelectedPython = (): Promise<undefined> => {
    isAsked = true;
    return Promise.resolve(undefined);
  };
  await findServer(createPlaces({ ...EVERYWHERE, getSelectedPython }), succeedOnlyFor("/work/.venv/bin/python"));
  expect(isAsked).toBe(false);
});

test("Linkwright is installed into the preferred interpreter", async () => {
  const search = await findServer(createPlaces({ ...EVERYWHERE, exists: () => false }), succeedOnlyFor("none"));
  expect(search.candidate).toBeUndefined();
  expect(findInstallTarget(search)).toBe("/conda/bin/python");
});

test("nothing is installed beside a linkwright on the PATH, which another program manages", async () => {
  const search = await findServer(createPlaces({ findOnPath: EVERYWHERE.findOnPath }), succeedOnlyFor("none"));
  expect(search.failures).toHaveLength(1);
  expect(findInstallTarget(search)).toBeUndefined();
});
