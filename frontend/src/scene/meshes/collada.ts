import { LoaderUtils } from "three";
import { ColladaLoader } from "three/addons/loaders/ColladaLoader.js";
import { strings } from "../../strings";
import type { MeshFiles } from "./mesh-files";
import { MeshError } from "./mesh-error";
import { flatten, template, type MeshTemplate } from "./mesh-template";
import { TextureWait } from "./texture-wait";

/**
 * COLLADA. Its unit is applied; its up axis is not, for RViz tells Assimp to ignore it: what the file calls z is the
 * link's z.
 *
 * @throws MeshError when it is none.
 */
export async function readCollada(data: ArrayBuffer, url: string, files: MeshFiles): Promise<MeshTemplate> {
  const written = new TextDecoder().decode(data).replace(/<up_axis>\s*\w+\s*<\/up_axis>/, "<up_axis>Y_UP</up_axis>");
  const text = checkedXml(written);
  const wait = new TextureWait(files);
  const collada = new ColladaLoader(wait.manager).parse(text, LoaderUtils.extractUrlBase(url));
  if (!collada) throw new MeshError(strings.meshes.dae.notXml(""));
  const problem = await wait.settle();
  // The loader's stand-in for a missing material is magenta and has no name.
  return template("DAE", flatten(collada.scene, (material) => material.name !== ""), problem);
}

/** The text as XML; the loader tells only the console where it failed. */
function checkedXml(written: string): string {
  let text = written;
  let xml = parsed(text);
  const broken = fault(xml);
  if (broken) {
    text = mended(written);
    xml = parsed(text);
    // Browsers report the error in words of their own; all of them have the line as their first number behind "line".
    const line = /line\D*(\d+)/i.exec(broken.textContent)?.[1] ?? "";
    if (fault(xml)) throw new MeshError(strings.meshes.dae.notXml(line));
  }
  const root = xml.documentElement.tagName;
  if (root.replace(/^.*:/, "") !== "COLLADA") throw new MeshError(strings.meshes.dae.root(root));
  return text;
}

function parsed(text: string): Document {
  return new DOMParser().parseFromString(text, "application/xml");
}

function fault(xml: Document): Element | undefined {
  return xml.getElementsByTagName("parsererror")[0];
}

/**
 * The text without what XML forbids and the readers of RViz and Gazebo take: `<` and `&` in values, as in the
 * `<STL_BINARY>` that assimp names nodes by, hyphens in comments, no blank between attributes.
 */
export function mended(text: string): string {
  return text
    .replace(/<!--[\s\S]*?-->/g, "")
    .replace(/&(?!#\d+;|#x[\da-f]+;|\w+;)/gi, "&amp;")
    .replace(/<[\w:](?:"[^"]*"|'[^']*'|[^"'<>])*>/g, (tag) =>
      tag.replace(/"[^"]*"|'[^']*'/g, (value) => `${value.replace(/</g, "&lt;")} `),
    );
}
