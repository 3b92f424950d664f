import { python } from "@codemirror/lang-python";
import { xml } from "@codemirror/lang-xml";
import { yaml } from "@codemirror/lang-yaml";
import type { Extension } from "@codemirror/state";

const XML = /\.(xacro|urdf|srdf|sdf|world|launch|xml|dae)$/i;
const YAML = /\.(ya?ml|rviz|repos)$/i;
const PYTHON = /\.pyi?$/i;

/** Returns the syntax of a file by its name; none for other files. */
export function syntaxOf(path: string): Extension {
  if (XML.test(path)) return xml();
  if (YAML.test(path)) return yaml();
  return PYTHON.test(path) ? python() : [];
}

/** Returns the language server's name of a file's language. */
export function languageOf(path: string): string {
  if (XML.test(path)) return "xml";
  if (YAML.test(path)) return "yaml";
  return PYTHON.test(path) ? "python" : "plaintext";
}

/** Returns one step of the indentation that a text uses, two spaces by default. */
export function detectIndentation(text: string): string {
  const indentation = /^(\t|  +)\S/m.exec(text)?.[1];
  return indentation === undefined || indentation.length > 8 ? "  " : indentation;
}
