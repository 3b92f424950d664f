import type { Plugin } from "vite";
import { defineConfig } from "vitest/config";

/** Dockview's style sheet without its themes, which are two thirds of it: the page has one of its own. */
function withoutThemes(): Plugin {
  return {
    name: "without-dockview-themes",
    enforce: "pre",
    transform: (code, id) => (id.endsWith("/dockview.css") ? code.replace(/^\.dockview-theme-[^{]*\{[^}]*\}\n/gm, "") : null),
  };
}

// The page is served from a folder of the Python package, below whatever path a proxy gives it: hence the relative base.
export default defineConfig({
  plugins: [withoutThemes()],
  base: "./",
  build: {
    outDir: "../src/linkwright/page/built",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 900,
  },
  test: {
    include: ["test/**/*.test.ts"],
    // Colors and edges are tested; other styles are nothing to tests.
    css: { include: [/theme\.css/, /controls\.css/] },
  },
});
