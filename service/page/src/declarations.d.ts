declare module "*.css";
declare module "*.bin" {
  const content: Uint8Array;
  export default content;
}
