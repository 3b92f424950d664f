import { spawn } from "node:child_process";
import { appendArguments, type Command, createEnvironment } from "./command.js";

const TIMEOUT_MS = 30_000;

/**
 * Return why a command cannot run the language server; undefined if it can.
 *
 * The server is started without input, so it ends at once, with status 0 if Linkwright and its extra `lsp` are installed.
 *
 * @param cwd the working directory; undefined means that of this process.
 */
export function probe(command: Command, cwd: string | undefined): Promise<string | undefined> {
  const { program, args } = appendArguments(command, "lsp");
  return new Promise((resolve) => {
    const child = spawn(program, args, {
      cwd,
      env: createEnvironment(),
      stdio: ["ignore", "ignore", "pipe"],
      timeout: TIMEOUT_MS,
    });
    let errorOutput = "";
    child.stderr.setEncoding("utf8").on("data", (text: string) => (errorOutput += text));
    child.on("error", (error) => resolve(error.message));
    child.on("close", (status, signal) => {
      if (status === 0) resolve(undefined);
      else resolve(extractReason(errorOutput) ?? `it ended with ${signal ?? `status ${status ?? "unknown"}`}`);
    });
  });
}

/** Return the line of an error output that names the error: the first with "error", else the last; undefined if empty. */
function extractReason(errorOutput: string): string | undefined {
  const lines = errorOutput.split("\n").map((line) => line.trim());
  return lines.find((line) => line.startsWith("error")) ?? lines.findLast((line) => line !== "");
}
