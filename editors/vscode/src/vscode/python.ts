import { type Event, extensions, type Uri } from "vscode";

/** The part of the Python extension's interface that is used here. */
interface PythonApi {
  readonly environments: {
    readonly onDidChangeActiveEnvironmentPath: Event<unknown>;
    getActiveEnvironmentPath(resource?: Uri): { readonly path: string };
    resolveEnvironment(path: { readonly path: string }): Promise<{ readonly executable: { readonly uri?: Uri } } | undefined>;
  };
}

/** Return the interface of the Python extension; undefined if it is not installed or has another interface. */
async function api(): Promise<PythonApi | undefined> {
  const exports = (await extensions.getExtension<Partial<PythonApi> | undefined>("ms-python.python")?.activate());
  return exports?.environments === undefined ? undefined : { environments: exports.environments };
}

/** Return the interpreter that is selected in the Python extension. */
export async function selectedPython(): Promise<string | undefined> {
  const environments = (await api())?.environments;
  const environment = await environments?.resolveEnvironment(environments.getActiveEnvironmentPath());
  return environment?.executable.uri?.fsPath;
}

/** Return the event of another selected interpreter, if the Python extension is installed. */
export async function selectedPythonChanged(): Promise<Event<unknown> | undefined> {
  return (await api())?.environments.onDidChangeActiveEnvironmentPath;
}
