import { LoaderUtils } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { strings } from "../../strings";
import type { MeshFiles } from "./mesh-files";
import { formatCount, MeshError, quoteNames } from "./mesh-error";
import { flatten, createTemplate, type MeshTemplate } from "./mesh-template";
import { TextureTracker } from "./texture-tracker";

const GLB_HEADER_BYTES = 12;
/** Extensions that are not supported, because they need decoders of their own. */
const UNSUPPORTED_EXTENSIONS = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_texture_basisu"];

interface GltfHeader {
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
  checkHeader(readHeader(data, isBinary));
  const textureTracker = new TextureTracker(files);
  const loading = new GLTFLoader(textureTracker.manager).parseAsync(data, LoaderUtils.extractUrlBase(url));
  const { scene } = await loading.catch((error: unknown) => {
    throw textureTracker.missingNames.length > 0 ? new MeshError(strings.meshes.missing(quoteNames(textureTracker.missingNames))) : error;
  });
  const problem = await textureTracker.settle();
  scene.rotation.set(Math.PI / 2, 0, 0);
  return createTemplate("glTF", flatten(scene, () => true), problem);
}

function readHeader(data: ArrayBuffer, isBinary: boolean): GltfHeader {
  const texts = strings.meshes.gltf;
  const magic = String.fromCharCode(...new Uint8Array(data, 0, Math.min(4, data.byteLength)));
  return magic === "glTF" ? readGlbHeader(data) : parseHeader(data, isBinary ? texts.magic : texts.notJson);
}

/** Returns the JSON of a GLB file, which is its first chunk. */
function readGlbHeader(data: ArrayBuffer): GltfHeader {
  const texts = strings.meshes.gltf;
  const view = new DataView(data);
  const statedLength = data.byteLength < GLB_HEADER_BYTES ? GLB_HEADER_BYTES : view.getUint32(8, true);
  if (statedLength > data.byteLength) throw new MeshError(texts.length(formatCount(statedLength), formatCount(data.byteLength)));
  const version = view.getUint32(4, true);
  if (version !== 2) throw new MeshError(texts.version(String(version)));
  const length = data.byteLength < GLB_HEADER_BYTES + 8 ? 0 : view.getUint32(GLB_HEADER_BYTES, true);
  const start = GLB_HEADER_BYTES + 8;
  return parseHeader(data.slice(start, start + length), texts.notJson);
}

function parseHeader(json: ArrayBuffer, errorText: string): GltfHeader {
  try {
    return JSON.parse(new TextDecoder().decode(json)) as GltfHeader;
  } catch {
    throw new MeshError(errorText);
  }
}

function checkHeader(header: GltfHeader): void {
  const version = header.asset?.version ?? "1.0";
  if (!version.startsWith("2.")) throw new MeshError(strings.meshes.gltf.version(version));
  const unsupportedExtensions = UNSUPPORTED_EXTENSIONS.filter((name) => header.extensionsRequired?.includes(name));
  if (unsupportedExtensions.length > 0) throw new MeshError(strings.meshes.gltf.extension(quoteNames(unsupportedExtensions)));
}
