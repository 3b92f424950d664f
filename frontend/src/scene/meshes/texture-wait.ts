import { LoadingManager } from "three";
import { strings } from "../../strings";
import { quoteNames } from "./mesh-error";
import type { MeshFiles } from "./mesh-files";

/** A loading manager that tracks the textures a loader requests, and which of them failed. */
export class TextureWait {
  readonly manager: LoadingManager;
  /** The names of files that could not be loaded. */
  readonly missingUrls: string[] = [];
  private pendingCount = 0;
  private wake: (() => void) | null = null;

  constructor(files: MeshFiles) {
    const manager = new LoadingManager();
    manager.setURLModifier((url) => files.addressOf(url));
    const { itemStart, itemEnd, itemError } = manager;
    manager.itemStart = (url): void => {
      this.pendingCount += 1;
      itemStart(url);
    };
    manager.itemEnd = (url): void => {
      this.pendingCount -= 1;
      itemEnd(url);
      if (this.pendingCount === 0) this.wake?.();
    };
    manager.itemError = (url): void => {
      this.missingUrls.push(decodeURIComponent(url.split("/").pop() ?? url));
      itemError(url);
    };
    this.manager = manager;
  }

  /** Waits for the textures requested so far; returns a sentence about the missing ones, or null. */
  async settle(): Promise<string | null> {
    if (this.pendingCount > 0) await new Promise<void>((resolve) => (this.wake = resolve));
    if (this.missingUrls.length === 0) return null;
    return strings.meshes.missingTextures(quoteNames(this.missingUrls));
  }
}
