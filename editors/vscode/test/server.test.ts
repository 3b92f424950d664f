import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { afterEach, beforeEach, describe, expect, test } from "vitest";
import {
  createProtocolConnection,
  type Diagnostic,
  DidOpenTextDocumentNotification,
  ExitNotification,
  InitializedNotification,
  InitializeRequest,
  type ProtocolConnection,
  PublishDiagnosticsNotification,
  ShutdownRequest,
  StreamMessageReader,
  StreamMessageWriter,
} from "vscode-languageserver-protocol/node";
import { appendArguments, type Command, createEnvironment, moduleCommandFor } from "../src/server/command.js";
import { findServer } from "../src/server/finder.js";
import { probe } from "../src/server/probe.js";
import { createPlaces } from "./places.js";
import { HAS_SAFE_PATH, PYTHON } from "./program.js";

const BROKEN_XACRO = `<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="bar" params="name"><link name="\${name}"/></xacro:macro>
  <xacro:barr name="upper"/>
</robot>
`;

let folder: string;
beforeEach(() => void (folder = mkdtempSync(join(tmpdir(), "linkwright-vscode-"))));
afterEach(() => rmSync(folder, { recursive: true }));

test("a program that is not there cannot run the server", async () => {
  expect(await probe(moduleCommandFor(join(folder, "python")), folder)).toContain("ENOENT");
});

describe.skipIf(PYTHON === undefined)("the real server", () => {
  const interpreter = PYTHON ?? "";

  test("finds the macro that does not exist", async () => {
    const { candidate } = await findServer(createPlaces({ interpreter }), (command) => probe(command, folder));
    const command = candidate?.command;
    expect(command).toEqual(moduleCommandFor(interpreter));
    const [diagnostic] = await runDiagnostics(command ?? moduleCommandFor(interpreter), "arm.urdf.xacro", BROKEN_XACRO);
    expect(diagnostic).toMatchObject({ code: "XAC401", source: "linkwright", range: { start: { line: 2, character: 2 } } });
  });

  test("does not run without its extra, and the probe returns the reason", async () => {
    const blocked = join(folder, "pygls");
    mkdirSync(blocked);
    writeFileSync(join(blocked, "__init__.py"), "raise ModuleNotFoundError('hidden', name='pygls')\n");
    const script = `import sys; sys.path.insert(0, ${JSON.stringify(folder)}); from linkwright.cli import main; sys.exit(main())`;
    const reason = await probe({ program: interpreter, args: ["-c", script] }, folder);
    expect(reason).toMatch(/^error\[CLI307\].*pygls/);
  });

  test.skipIf(!HAS_SAFE_PATH)("does not import modules of the workspace", async () => {
    writeFileSync(join(folder, "queue.py"), "raise SystemExit('imported from the workspace')\n");
    expect(await probe(moduleCommandFor(interpreter), folder)).toBeUndefined();
  });
});

/** Start the server, open a file in it, as an editor does, and return the first diagnostics published for it. */
async function runDiagnostics(command: Command, name: string, text: string): Promise<readonly Diagnostic[]> {
  const { program, args } = appendArguments(command, "lsp");
  const child = spawn(program, args, { cwd: folder, env: createEnvironment(), stdio: ["pipe", "pipe", "inherit"] });
  const exitStatus = new Promise((resolve) => child.on("close", resolve));
  const reader = new StreamMessageReader(child.stdout);
  const connection = createProtocolConnection(reader, new StreamMessageWriter(child.stdin));
  connection.listen();
  try {
    return await openDocument(connection, name, text);
  } finally {
    await connection.sendRequest(ShutdownRequest.type);
    await connection.sendNotification(ExitNotification.type);
    expect(await exitStatus).toBe(0);
    connection.dispose();
  }
}

async function openDocument(connection: ProtocolConnection, name: string, text: string): Promise<readonly Diagnostic[]> {
  const workspaceFolders = [{ uri: pathToFileURL(folder).href, name: "robot" }];
  const uri = pathToFileURL(join(folder, name)).href;
  writeFileSync(join(folder, name), text);
  const publishedDiagnostics = new Promise<readonly Diagnostic[]>((resolve) => {
    connection.onNotification(PublishDiagnosticsNotification.type, (params) => {
      if (params.uri === uri) resolve(params.diagnostics);
    });
  });
  await connection.sendRequest(InitializeRequest.type, {
    processId: process.pid,
    rootUri: null, // eslint-disable-line @typescript-eslint/no-deprecated -- the type asks for it
    capabilities: {},
    workspaceFolders,
  });
  await connection.sendNotification(InitializedNotification.type, {});
  const textDocument = { uri, languageId: "xacro", version: 1, text };
  await connection.sendNotification(DidOpenTextDocumentNotification.type, { textDocument });
  return publishedDiagnostics;
}
