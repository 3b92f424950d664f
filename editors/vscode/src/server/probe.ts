import { spawn } from "node:child_process";
import { type Command, environment, extended } from "./command.js";

const LIMIT_MS = 30_000;

/**
 * Return why a command cannot run the language server; undefined if it can.
 *
 * Starts the server without input, so that it ends at once: with status 0 if Linkwright and its extra `lsp` are there.
 *
 * @param cwd the working directory; by default that of this process.
 */
export function probe(command: Command, cwd: string | undefined): Promise<string | undefined> {
  const { program, args } = extended(command, "lsp");
  return new Promise((resolve) => {
    const child = spawn(program, args, {
      cwd,
      env: environment(),
      stdio: ["ignore", "ignore", "pipe"],
      timeout: LIMIT_MS,
    });
    let printed = "";
    child.stderr.setEncoding("utf8").on("data", (text: string) => (printed += text));
    child.on("error", (error) => resolve(error.message));
    child.on("close", (status, signal) => {
      if (status === 0) resolve(undefined);
      else resolve(told(printed) ?? `it ended with ${signal ?? `status ${status ?? "unknown"}`}`);
    });
  });
}

/** Return the line of an error output that says what is wrong. */
function told(printed: string): string | undefined {
  const lines = printed.split("\n").map((line) => line.trim());
  return lines.find((line) => line.startsWith("error")) ?? lines.findLast((line) => line !== "");
}
