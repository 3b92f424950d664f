import { LoaderUtils } from "three";
import { ColladaLoader } from "three/addons/loaders/ColladaLoader.js";
import type { MeshFiles } from "./mesh-files";
import { flatten, type MeshTemplate } from "./mesh-template";
import { TextureWait } from "./texture-wait";

/**
 * COLLADA. Its unit is applied; its up axis is not, for RViz tells Assimp to ignore it: what the file calls z is the
 * link's z.
 */
export async function readCollada(data: ArrayBuffer, url: string, files: MeshFiles): Promise<MeshTemplate> {
  const text = new TextDecoder().decode(data).replace(/<up_axis>\s*\w+\s*<\/up_axis>/, "<up_axis>Y_UP</up_axis>");
  const wait = new TextureWait(files);
  const collada = new ColladaLoader(wait.manager).parse(text, LoaderUtils.extractUrlBase(url));
  if (!collada) throw new Error("the COLLADA file is not valid XML");
  const problem = await wait.settle();
  // The loader's stand-in for a missing material is magenta and has no name.
  const parts = flatten(collada.scene, (material) => material.name !== "");
  if (parts.length === 0) throw new Error("the COLLADA file has no meshes");
  return { parts, problem };
}
