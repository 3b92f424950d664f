import type { Command } from "./command.js";

/**
 * Return the requirement that pip installs for the language server.
 *
 * @param source the path of a checkout or wheel; if empty, Linkwright comes from the package index.
 */
export function formatRequirement(source: string): string {
  return `${source === "" ? "linkwright" : source}[lsp]`;
}

/** Return the command that installs the language server into a Python. */
export function installCommand(python: string, source: string): Command {
  return { program: python, args: ["-m", "pip", "install", formatRequirement(source)] };
}
