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
  const text = new TextDecoder().decode(data).replace(/<up_axis>\s*\w+\s*<\/up_axis>/, "<up_axis>Y_UP</up_axis>");
  checkXml(text);
  const wait = new TextureWait(files);
  const collada = new ColladaLoader(wait.manager).parse(text, LoaderUtils.extractUrlBase(url));
  if (!collada) throw new MeshError(strings.meshes.dae.notXml(""));
  const problem = await wait.settle();
  // The loader's stand-in for a missing material is magenta and has no name.
  return template("DAE", flatten(collada.scene, (material) => material.name !== ""), problem);
}

/** The loader tells only the console where it failed. */
function checkXml(text: string): void {
  const xml = new DOMParser().parseFromString(text, "application/xml");
  const [broken] = xml.getElementsByTagName("parsererror");
  // Browsers say it in words of their own; all of them have the line as their first number behind "line".
  if (broken) throw new MeshError(strings.meshes.dae.notXml(/line\D*(\d+)/i.exec(broken.textContent)?.[1] ?? ""));
  const root = xml.documentElement.tagName;
  if (root.replace(/^.*:/, "") !== "COLLADA") throw new MeshError(strings.meshes.dae.root(root));
}
