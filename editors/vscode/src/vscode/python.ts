import { type Event, extensions, type Uri } from "vscode";

/** The part of the Python extension's API that is used here. */
interface PythonApi {
  readonly environments: {
    readonly onDidChangeActiveEnvironmentPath: Event<unknown>;
    getActiveEnvironmentPath(resource?: Uri): { readonly path: string };
    resolveEnvironment(path: { readonly path: string }): Promise<{ readonly executable: { readonly uri?: Uri } } | undefined>;
  };
}

/** Return the API of the Python extension; undefined if the extension is not installed or has another API. */
async function getPythonApi(): Promise<PythonApi | undefined> {
  const exports = (await extensions.getExtension<Partial<PythonApi> | undefined>("ms-python.python")?.activate());
  return exports?.environments === undefined ? undefined : { environments: exports.environments };
}

/** Return the interpreter selected in the Python extension; undefined if the extension is not installed. */
export async function getSelectedPython(): Promise<string | undefined> {
  const environments = (await getPythonApi())?.environments;
  const environment = await environments?.resolveEnvironment(environments.getActiveEnvironmentPath());
  return environment?.executable.uri?.fsPath;
}

/** Return the event that fires when another interpreter is selected; undefined if the Python extension is not installed. */
export async function getSelectedPythonEvent(): Promise<Event<unknown> | undefined> {
  return (await getPythonApi())?.environments.onDidChangeActiveEnvironmentPath;
}
