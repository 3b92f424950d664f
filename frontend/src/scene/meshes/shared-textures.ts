import type { Texture } from "three";
import { loadTexture } from "../materials";

interface SharedTexture {
  readonly texture: Promise<Texture>;
  userCount: number;
}

/** Textures by address, each on the GPU only once however many shapes use it. */
export class SharedTextures {
  private readonly textures = new Map<string, SharedTexture>();

  constructor(private readonly load: (url: string) => Promise<Texture> = loadTexture) {}

  /** Returns the texture at `url`. The caller must release it with `release`, even if it cannot be loaded. */
  acquire(url: string): Promise<Texture> {
    let entry = this.textures.get(url);
    if (!entry) this.textures.set(url, (entry = { texture: this.load(url), userCount: 0 }));
    entry.userCount++;
    return entry.texture;
  }

  release(url: string): void {
    const entry = this.textures.get(url);
    if (!entry || --entry.userCount > 0) return;
    this.textures.delete(url);
    entry.texture.then(
      (texture) => texture.dispose(),
      () => undefined,
    );
  }
}
