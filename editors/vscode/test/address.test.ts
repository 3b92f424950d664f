import { expect, test } from "vitest";
import { addressIn, withoutToken } from "../src/page/address.js";

test("the address is read from its line", () => {
  expect(addressIn("Viewer: http://127.0.0.1:7448/?token=a_-b")).toBe("http://127.0.0.1:7448/?token=a_-b");
});

test("other lines have none", () => {
  expect(addressIn("[INFO] [viewer-3]: started in the launcher's process")).toBeUndefined();
});

test("the output does not get the token", () => {
  expect(withoutToken("Viewer: http://127.0.0.1:7448/?token=a_-b")).toBe("Viewer: http://127.0.0.1:7448/?token=...");
});
