import { LoaderUtils } from "three";
import { ColladaLoader } from "three/addons/loaders/ColladaLoader.js";
import { strings } from "../../strings";
import type { MeshFiles } from "./mesh-files";
import { MeshError } from "./mesh-error";
import { flatten, createTemplate, type MeshTemplate } from "./mesh-template";
import { TextureTracker } from "./texture-tracker";

/**
 * Reads COLLADA. Its unit is applied, but not its up axis, because RViz tells Assimp to ignore it: z in the file is z
 * of the link.
 *
 * @throws MeshError if the file is not valid COLLADA.
 */
export async function readCollada(data: ArrayBuffer, url: string, files: MeshFiles): Promise<MeshTemplate> {
  const xmlText = new TextDecoder().decode(data).replace(/<up_axis>\s*\w+\s*<\/up_axis>/, "<up_axis>Y_UP</up_axis>");
  const text = checkXml(xmlText);
  const textureTracker = new TextureTracker(files);
  const collada = new ColladaLoader(textureTracker.manager).parse(text, LoaderUtils.extractUrlBase(url));
  if (!collada) throw new MeshError(strings.meshes.dae.notXml(""));
  const problem = await textureTracker.settle();
  // The loader replaces a missing material by a magenta one without a name.
  return createTemplate("DAE", flatten(collada.scene, (material) => material.name !== ""), problem);
}

/** Returns the text as valid XML. The loader itself reports errors only on the console. */
function checkXml(xmlText: string): string {
  let text = xmlText;
  let xml = parseXml(text);
  const parserError = findParserError(xml);
  if (parserError) {
    text = fixXml(xmlText);
    xml = parseXml(text);
    // Browsers word the error differently, but all of them have the line as the first number after "line".
    const line = /line\D*(\d+)/i.exec(parserError.textContent)?.[1] ?? "";
    if (findParserError(xml)) throw new MeshError(strings.meshes.dae.notXml(line));
  }
  const root = xml.documentElement.tagName;
  if (root.replace(/^.*:/, "") !== "COLLADA") throw new MeshError(strings.meshes.dae.root(root));
  return text;
}

function parseXml(text: string): Document {
  return new DOMParser().parseFromString(text, "application/xml");
}

function findParserError(xml: Document): Element | undefined {
  return xml.getElementsByTagName("parsererror")[0];
}

/**
 * Fixes what XML forbids but the readers of RViz and Gazebo accept: `<` and `&` in values, as in the node name
 * `<STL_BINARY>` of assimp, hyphens in comments, and missing blanks between attributes.
 */
export function fixXml(text: string): string {
  return text
    .replace(/<!--[\s\S]*?-->/g, "")
    .replace(/&(?!#\d+;|#x[\da-f]+;|\w+;)/gi, "&amp;")
    .replace(/<[\w:](?:"[^"]*"|'[^']*'|[^"'<>])*>/g, (tag) =>
      tag.replace(/"[^"]*"|'[^']*'/g, (value) => `${value.replace(/</g, "&lt;")} `),
    );
}
