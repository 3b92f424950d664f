import { readFileSync } from "node:fs";
import { expect, test } from "vitest";

interface Manifest {
  readonly contributes: {
    readonly commands: readonly { readonly command: string }[];
    readonly languages: readonly { readonly id: string; readonly configuration?: string }[];
    readonly grammars: readonly { readonly language: string; readonly scopeName: string; readonly path: string }[];
    readonly configuration: { readonly properties: Readonly<Record<string, unknown>> };
  };
}

const { contributes } = JSON.parse(readFileSync("package.json", "utf8")) as Manifest;
const README = readFileSync("README.md", "utf8");

test("the commands of the manifest are registered", () => {
  const source = readFileSync("src/vscode/extension.ts", "utf8");
  const registeredCommands = [...source.matchAll(/registerCommand\("([^"]+)"/g)].map((match) => match[1]);
  expect(registeredCommands.sort()).toEqual(contributes.commands.map(({ command }) => command).sort());
});

test("each language has a grammar with the scope that its file declares", () => {
  // Languages without a configuration are defined by VS Code.
  const ownLanguages = contributes.languages.filter(({ configuration }) => configuration !== undefined);
  expect(contributes.grammars.map(({ language }) => language)).toEqual(ownLanguages.map(({ id }) => id));
  for (const { path, scopeName } of contributes.grammars) {
    const grammar = JSON.parse(readFileSync(path, "utf8")) as { readonly scopeName: string };
    expect(grammar.scopeName).toBe(scopeName);
  }
});

test("the README explains all settings", () => {
  for (const setting of Object.keys(contributes.configuration.properties)) expect(README).toContain(`\`${setting}\``);
});
