import { LoadingManager } from "three";
import { strings } from "../../strings";
import { quoted } from "./mesh-error";
import type { MeshFiles } from "./mesh-files";

/** A loading manager that knows when the textures a loader started have come, and which did not. */
export class TextureWait {
  readonly manager: LoadingManager;
  /** The names of files that did not come. */
  readonly missing: string[] = [];
  private pending = 0;
  private wake: (() => void) | null = null;

  constructor(files: MeshFiles) {
    const manager = new LoadingManager();
    manager.setURLModifier((url) => files.address(url));
    const { itemStart, itemEnd, itemError } = manager;
    manager.itemStart = (url): void => {
      this.pending += 1;
      itemStart(url);
    };
    manager.itemEnd = (url): void => {
      this.pending -= 1;
      itemEnd(url);
      if (this.pending === 0) this.wake?.();
    };
    manager.itemError = (url): void => {
      this.missing.push(decodeURIComponent(url.split("/").pop() ?? url));
      itemError(url);
    };
    this.manager = manager;
  }

  /** Waits for the textures started so far; a sentence about the missing ones, or null. */
  async settle(): Promise<string | null> {
    if (this.pending > 0) await new Promise<void>((resolve) => (this.wake = resolve));
    if (this.missing.length === 0) return null;
    return strings.meshes.missingTextures(quoted(this.missing));
  }
}
