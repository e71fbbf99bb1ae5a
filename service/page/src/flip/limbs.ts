// What turning limbs needs, loaded once a body is there.
export { bent } from "./bent";
export { markLimbs, reshape } from "./marks";
export { limbUnder } from "./picking";
