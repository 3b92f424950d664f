import { expect, test } from "vitest";
import { AddressReader } from "../src/page/address.js";

test("an address that comes in pieces is read when its line is complete", () => {
  const reader = new AddressReader();
  expect(reader.read("Viewer: http://127.0.0.1:7448/?tok")).toBeUndefined();
  expect(reader.read("en=abc")).toBeUndefined();
  expect(reader.read("\nmore\n")).toBe("http://127.0.0.1:7448/?token=abc");
});
