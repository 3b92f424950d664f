import { LoaderUtils } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import type { MeshFiles } from "./mesh-files";
import { flatten, type MeshTemplate } from "./mesh-template";
import { TextureWait } from "./texture-wait";

/** glTF, text or binary: y up by its specification, turned to z up as RViz does. */
export async function readGltf(data: ArrayBuffer, url: string, files: MeshFiles): Promise<MeshTemplate> {
  const wait = new TextureWait(files);
  const { scene } = await new GLTFLoader(wait.manager).parseAsync(data, LoaderUtils.extractUrlBase(url));
  const problem = await wait.settle();
  scene.rotation.set(Math.PI / 2, 0, 0);
  const parts = flatten(scene, () => true);
  if (parts.length === 0) throw new Error("the glTF file has no meshes");
  return { parts, problem };
}
