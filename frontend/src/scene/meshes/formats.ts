import { strings } from "../../strings";
import { MeshError } from "./mesh-error";
import type { MeshFiles } from "./mesh-files";
import type { MeshTemplate } from "./mesh-template";

/**
 * Reads a mesh file; the reader of a format is fetched with the first mesh of that format.
 *
 * @throws MeshError if the mesh cannot be drawn.
 */
export async function readMesh(data: ArrayBuffer, format: string, url: string, files: MeshFiles): Promise<MeshTemplate> {
  const reader = READERS.get(format);
  if (!reader) throw new MeshError(strings.meshes.noReader(format));
  if (data.byteLength === 0) throw new MeshError(strings.meshes.empty);
  try {
    return await reader(data, url, files);
  } catch (error) {
    if (error instanceof MeshError) throw error;
    console.warn(`The mesh ${url} cannot be read:`, error);
    throw new MeshError(strings.meshes.unreadable(format.toUpperCase()));
  }
}

type MeshReader = (data: ArrayBuffer, url: string, files: MeshFiles) => Promise<MeshTemplate>;

const readStl: MeshReader = async (data) => (await import("./stl")).readStl(data);

const READERS: ReadonlyMap<string, MeshReader> = new Map<string, MeshReader>([
  ["stl", readStl],
  ["stlb", readStl],
  ["dae", async (data, url, files) => (await import("./collada")).readCollada(data, url, files)],
  ["obj", async (data, url, files) => (await import("./obj")).readObj(data, url, files)],
  ["glb", async (data, url, files) => (await import("./gltf")).readGltf(data, url, files, true)],
  ["gltf", async (data, url, files) => (await import("./gltf")).readGltf(data, url, files, false)],
]);
