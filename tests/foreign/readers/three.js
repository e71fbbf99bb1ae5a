// Loads a GLB with three.js' GLTFLoader, as a page does, and prints what its scene shows as JSON.
import { readFile } from 'node:fs/promises';
import { AnimationMixer, Box3, LoopOnce, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// What a browser has and Node.js has not: pictures, of which three.js only keeps the size.
globalThis.self = globalThis;
globalThis.createImageBitmap = async (blob) => {
  const bytes = new DataView(await blob.arrayBuffer());
  return { width: bytes.getUint32(16), height: bytes.getUint32(20), close() {} };
};

// World positions as drawn: morph targets, skin and nodes applied.
function bounds(meshes) {
  const box = new Box3();
  const point = new Vector3();
  for (const mesh of meshes) {
    for (let i = 0; i < mesh.geometry.attributes.position.count; i++) {
      mesh.getVertexPosition(i, point);
      box.expandByPoint(point.applyMatrix4(mesh.matrixWorld));
    }
  }
  return { min: box.min.toArray(), max: box.max.toArray() };
}

const bytes = await readFile(process.argv[2]);
const content = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
const gltf = await new GLTFLoader().parseAsync(content, '');
const { scene } = gltf;

const found = { meshes: [], cameras: [], lights: [] };
scene.traverse((each) => {
  if (each.isMesh) found.meshes.push(each);
  if (each.isCamera) found.cameras.push(each);
  if (each.isLight) found.lights.push(each);
});

const told = {
  meshes: found.meshes.map((mesh) => ({
    vertices: mesh.geometry.attributes.position.count,
    triangles: mesh.geometry.index.count / 3,
    attributes: Object.keys(mesh.geometry.attributes).sort(),
    texture: mesh.material.map ? [mesh.material.map.image.width, mesh.material.map.image.height] : null,
    morphTargets: mesh.geometry.morphAttributes.position?.length ?? 0,
    bones: mesh.skeleton?.bones.length ?? 0,
  })),
  cameras: found.cameras.map(({ fov, aspect, matrixWorld, userData }) => ({
    fov, aspect, matrix: matrixWorld.toArray(), userData,
  })),
  lights: found.lights.map((light) => ({
    type: light.type,
    intensity: light.intensity,
    position: light.getWorldPosition(new Vector3()).toArray(),
  })),
  lightNode: scene.getObjectByName('light')?.getWorldPosition(new Vector3()).toArray() ?? null,
  extras: scene.userData,
};

scene.updateMatrixWorld(true);
told.bounds = bounds(found.meshes);
told.frames = [];
const [clip] = gltf.animations;
if (clip) {
  const mixer = new AnimationMixer(scene);
  const action = mixer.clipAction(clip);
  action.setLoop(LoopOnce, 1);
  action.clampWhenFinished = true;
  action.play();
  for (const time of [0, clip.duration / 2, clip.duration]) {
    mixer.setTime(time);
    scene.updateMatrixWorld(true);
    for (const mesh of found.meshes) mesh.skeleton?.update();
    told.frames.push({ time, ...bounds(found.meshes) });
  }
}
console.log(JSON.stringify(told));
