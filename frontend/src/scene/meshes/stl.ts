import { STLLoader } from "three/addons/loaders/STLLoader.js";
import type { MeshTemplate } from "./mesh-template";

/** STL, text or binary. RViz knows no colours in it: the link's material applies. */
export function readStl(data: ArrayBuffer): MeshTemplate {
  const geometry = new STLLoader().parse(data);
  if (geometry.getAttribute("position").count === 0) throw new Error("the STL file has no triangles");
  geometry.clearGroups();
  geometry.deleteAttribute("color");
  // Exporters leave normals at zero; RViz's loader computes them.
  geometry.computeVertexNormals();
  return { parts: [{ geometry, materials: [null] }], problem: null };
}
