import { LoaderUtils } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { strings } from "../../strings";
import type { MeshFiles } from "./mesh-files";
import { countText, MeshError, quoteNames } from "./mesh-error";
import { flatten, createTemplate, type MeshTemplate } from "./mesh-template";
import { TextureWait } from "./texture-wait";

const GLB_HEADER_BYTES = 12;
/** Extensions that are not supported, because they need decoders of their own. */
const UNSUPPORTED = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_texture_basisu"];

interface Head {
  asset?: { version?: string };
  extensionsRequired?: string[];
}

/**
 * Reads glTF, text or binary. It has y up by its specification, and is turned to z up as in RViz.
 *
 * @param isBinary - whether the file extension is that of binary glTF; the first bytes decide.
 * @throws MeshError if the file is not glTF, or needs an unsupported extension.
 */
export async function readGltf(data: ArrayBuffer, url: string, files: MeshFiles, isBinary: boolean): Promise<MeshTemplate> {
  checkHead(headOf(data, isBinary));
  const wait = new TextureWait(files);
  const loading = new GLTFLoader(wait.manager).parseAsync(data, LoaderUtils.extractUrlBase(url));
  const { scene } = await loading.catch((error: unknown) => {
    throw wait.missingUrls.length > 0 ? new MeshError(strings.meshes.missing(quoteNames(wait.missingUrls))) : error;
  });
  const problem = await wait.settle();
  scene.rotation.set(Math.PI / 2, 0, 0);
  return createTemplate("glTF", flatten(scene, () => true), problem);
}

function headOf(data: ArrayBuffer, isBinary: boolean): Head {
  const texts = strings.meshes.gltf;
  const magic = String.fromCharCode(...new Uint8Array(data, 0, Math.min(4, data.byteLength)));
  return magic === "glTF" ? readGlbHead(data) : parseHead(data, isBinary ? texts.magic : texts.notJson);
}

/** Returns the JSON of a GLB file, which is its first chunk. */
function readGlbHead(data: ArrayBuffer): Head {
  const texts = strings.meshes.gltf;
  const view = new DataView(data);
  const statedLength = data.byteLength < GLB_HEADER_BYTES ? GLB_HEADER_BYTES : view.getUint32(8, true);
  if (statedLength > data.byteLength) throw new MeshError(texts.length(countText(statedLength), countText(data.byteLength)));
  const version = view.getUint32(4, true);
  if (version !== 2) throw new MeshError(texts.version(String(version)));
  const length = data.byteLength < GLB_HEADER_BYTES + 8 ? 0 : view.getUint32(GLB_HEADER_BYTES, true);
  const start = GLB_HEADER_BYTES + 8;
  return parseHead(data.slice(start, start + length), texts.notJson);
}

function parseHead(json: ArrayBuffer, otherwise: string): Head {
  try {
    return JSON.parse(new TextDecoder().decode(json)) as Head;
  } catch {
    throw new MeshError(otherwise);
  }
}

function checkHead(head: Head): void {
  const version = head.asset?.version ?? "1.0";
  if (!version.startsWith("2.")) throw new MeshError(strings.meshes.gltf.version(version));
  const lacking = UNSUPPORTED.filter((name) => head.extensionsRequired?.includes(name));
  if (lacking.length > 0) throw new MeshError(strings.meshes.gltf.extension(quoteNames(lacking)));
}
