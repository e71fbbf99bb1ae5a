// Plays a GLB or BVH file with three.js: `node play.js FILE SECONDS...` or, of a rig, `node play.js FILE '{"bone": [x, y, z, w]}'...`.
// Prints for each moment, or for each way to turn bones, where bones and vertices are: {"bones": {name: [x, y, z]}, "vertices": [[x, y, z]...]}.
import { readFile } from 'node:fs/promises';
import { AnimationMixer, Texture, Vector3 } from 'three';
import { BVHLoader } from 'three/examples/jsm/loaders/BVHLoader.js';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

const [path, ...moments] = process.argv.slice(2);
const { scene, animations } = path.endsWith('.bvh') ? bvh(await readFile(path, 'utf8')) : await glb(await readFile(path));
const mixer = new AnimationMixer(scene);
for (const clip of animations) mixer.clipAction(clip).play();
console.log(JSON.stringify(moments.map(moment)));

function bvh(text) {
  const { skeleton, clip } = new BVHLoader().parse(text);
  return { scene: skeleton.bones[0], animations: [clip] };
}

function glb(content) {
  // Pictures need a browser.
  const loader = new GLTFLoader().register(() => ({ name: 'no pictures', loadTexture: async () => new Texture() }));
  return loader.parseAsync(content.buffer.slice(content.byteOffset, content.byteOffset + content.byteLength), '');
}

function moment(text) {
  const asked = JSON.parse(text);
  if (typeof asked === 'number') mixer.setTime(asked);
  const bones = [];
  const meshes = [];
  scene.traverse((node) => {
    if (node.isBone) bones.push(node);
    if (node.isMesh) meshes.push(node);
  });
  const nameOf = (bone) => bone.userData.name ?? bone.name;
  for (const bone of bones) if (typeof asked !== 'number') bone.quaternion.fromArray(asked[nameOf(bone)] ?? [0, 0, 0, 1]);
  scene.updateMatrixWorld(true);
  return {
    bones: Object.fromEntries(bones.map((bone) => [nameOf(bone), bone.getWorldPosition(new Vector3()).toArray()])),
    vertices: meshes.flatMap((mesh) => {
      mesh.skeleton?.update();
      const { count } = mesh.geometry.attributes.position;
      return Array.from({ length: count }, (_, i) => mesh.localToWorld(mesh.getVertexPosition(i, new Vector3())).toArray());
    }),
  };
}
