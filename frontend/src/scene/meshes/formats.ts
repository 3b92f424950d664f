import type { MeshFiles } from "./mesh-files";
import type { MeshTemplate } from "./mesh-template";

/** Reads a mesh file; each format's reader is fetched when the first such mesh comes. */
export async function readMesh(data: ArrayBuffer, format: string, url: string, files: MeshFiles): Promise<MeshTemplate> {
  switch (format) {
    case "stl":
    case "stlb":
      return (await import("./stl")).readStl(data);
    case "dae":
      return (await import("./collada")).readCollada(data, url, files);
    case "obj":
      return (await import("./obj")).readObj(data, url, files);
    case "glb":
    case "gltf":
      return (await import("./gltf")).readGltf(data, url, files);
    default:
      throw new Error(`no reader for '.${format}' meshes; STL, DAE, OBJ, GLB and GLTF are read`);
  }
}
