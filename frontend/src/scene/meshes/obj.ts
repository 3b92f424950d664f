import { LoaderUtils } from "three";
import { MTLLoader } from "three/addons/loaders/MTLLoader.js";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import { strings } from "../../strings";
import { MeshError } from "./mesh-error";
import type { MeshFiles } from "./mesh-files";
import { flatten, createTemplate, type MeshTemplate } from "./mesh-template";
import { TextureTracker } from "./texture-tracker";

/**
 * Reads Wavefront OBJ with its MTL files and their textures.
 *
 * @throws MeshError if the file is not valid OBJ.
 */
export async function readObj(data: ArrayBuffer, url: string, files: MeshFiles): Promise<MeshTemplate> {
  const text = new TextDecoder().decode(data);
  if (!/^[ \t]*v[ \t]/m.test(text)) throw new MeshError(strings.meshes.noVertices);
  const folder = LoaderUtils.extractUrlBase(url);
  const textureTracker = new TextureTracker(files);
  const loader = new OBJLoader(textureTracker.manager);
  const problems: string[] = [];
  const knownMaterials = new Set<string>();
  for (const name of listMaterialFiles(text)) {
    const response = await files.fetch(folder + name.split("/").map(encodeURIComponent).join("/"));
    if (!response.ok) {
      problems.push(strings.meshes.missingMaterials(name));
      continue;
    }
    const materials = new MTLLoader(textureTracker.manager).parse(await response.text(), folder);
    materials.preload();
    for (const name of Object.keys(materials.materials)) knownMaterials.add(name);
    loader.setMaterials(materials);
  }
  const root = loader.parse(text);
  const textureProblem = await textureTracker.settle();
  if (textureProblem) problems.push(textureProblem);
  return createTemplate("OBJ", flatten(root, (material) => knownMaterials.has(material.name)), problems.join("; ") || null);
}

/** Returns the files named by `mtllib` lines. A name may contain spaces: each line names one file. */
export function listMaterialFiles(obj: string): string[] {
  return [...obj.matchAll(/^[ \t]*mtllib[ \t]+(.+?)[ \t]*\r?$/gm)].map((match) => match[1] ?? "");
}
