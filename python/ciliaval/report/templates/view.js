// SPDX-License-Identifier: LGPL-2.1-or-later
// Draws each <div class="view"> from its JSON (ciliaval/report/view3d.py) with three.js. z is up.
"use strict";
(function () {
  const around = 24; // points of a ring

  // Viridis at nine places.
  const viridis = ["440154", "472d7b", "3b528b", "2c728e", "21918c", "28ae80", "5ec962", "addc30", "fde725"];
  function colour(byte) {
    const at = (byte / 255) * (viridis.length - 1);
    const i = Math.min(Math.floor(at), viridis.length - 2);
    const parts = [0, 2, 4].map((k) => {
      const low = parseInt(viridis[i].slice(k, k + 2), 16);
      const high = parseInt(viridis[i + 1].slice(k, k + 2), 16);
      return Math.round(low + (high - low) * (at - i));
    });
    return parts;
  }

  // The surface of the segment between the arc lengths from and to, of a circular or rectangular section.
  function tube(step, data, from, to) {
    const c = Math.cos(step.azimuth), s = Math.sin(step.azimuth);
    const rows = [];
    const at = (S) => {
      let i = 0;
      while (i < step.S.length - 2 && step.S[i + 1] < S) ++i;
      const t = (S - step.S[i]) / (step.S[i + 1] - step.S[i]);
      const mix = (a, k, n) => a[n * i + k] * (1 - t) + a[n * (i + 1) + k] * t;
      return { p: [0, 1, 2].map((k) => mix(step.points, k, 3)), theta: mix(step.theta, 0, 1) };
    };
    const inner = step.S.filter((S) => S > from && S < to);
    for (const S of [from, ...inner, to]) rows.push(at(S));
    const positions = [], index = [];
    for (const { p, theta } of rows)
      for (let j = 0; j < around; ++j) {
        const a = (2 * Math.PI * j) / around;
        // Of a rectangle the point of the outline in the direction a.
        const m = data.is_rectangle ? Math.max(Math.abs(Math.cos(a)), Math.abs(Math.sin(a))) : 1;
        const u = (data.extents[0] / 2) * Math.cos(a) / m, v = (data.extents[1] / 2) * Math.sin(a) / m;
        // In the section: u along the rotated direction of the load, v across.
        const n = [c * Math.cos(theta), s * Math.cos(theta), -Math.sin(theta)];
        positions.push(p[0] + u * n[0] - v * s, p[1] + u * n[1] + v * c, p[2] + u * n[2]);
      }
    for (let i = 0; i + 1 < rows.length; ++i)
      for (let j = 0; j < around; ++j) {
        const a = i * around + j, b = i * around + ((j + 1) % around);
        index.push(a, b, a + around, b, b + around, a + around);
      }
    const cap = (ring, flip) => {
      const start = positions.length / 3;
      const p = rows[ring].p;
      positions.push(p[0], p[1], p[2]);
      for (let j = 0; j < around; ++j)
        positions.push(...positions.slice(3 * (ring * around + j), 3 * (ring * around + j) + 3));
      for (let j = 0; j < around; ++j) {
        const a = start + 1 + j, b = start + 1 + ((j + 1) % around);
        index.push(start, flip ? b : a, flip ? a : b);
      }
    };
    cap(0, true);
    cap(rows.length - 1, false);
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(index);
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
    geometry.computeVertexNormals();
    return geometry;
  }

  function plane(step, pixels) {
    const raw = atob(step.plane.values);
    const data = new Uint8Array(3 * pixels * pixels);
    for (let i = 0; i < raw.length; ++i) data.set(colour(raw.charCodeAt(i)), 3 * i);
    const texture = new THREE.DataTexture(data, pixels, pixels, THREE.RGBFormat);
    texture.magFilter = texture.minFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    const [left, right, bottom, top] = step.plane.window;
    const c = Math.cos(step.azimuth), s = Math.sin(step.azimuth);
    const geometry = new THREE.BufferGeometry();
    const corners = [[left, bottom], [right, bottom], [right, top], [left, top]];
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners.flatMap(([x, z]) => [c * x, s * x, z]), 3));
    geometry.setAttribute("uv", new THREE.Float32BufferAttribute([0, 0, 1, 0, 1, 1, 0, 1], 2));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    return new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ map: texture, side: THREE.DoubleSide, transparent: true, opacity: 0.75 }));
  }

  function start(box) {
    const data = JSON.parse(box.querySelector("script[type='application/json']").textContent);
    const canvas = box.querySelector("canvas"), words = box.querySelector("output"), slider = box.querySelector("input");
    let renderer;
    try {
      renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    } catch (error) {
      box.querySelector(".sorry").hidden = false;
      canvas.hidden = true;
      return;
    }
    const length = data.segments.reduce((sum, s) => sum + s.length, 0);
    const scene = new THREE.Scene();
    scene.add(new THREE.HemisphereLight(0xffffff, 0x888888, 0.9));
    const sun = new THREE.DirectionalLight(0xffffff, 0.5);
    sun.position.set(1, -2, 3);
    scene.add(sun);
    const camera = new THREE.PerspectiveCamera(35, 1, length / 100, length * 50);
    camera.up.set(0, 0, 1);
    // Across the plane of the load, somewhat from above.
    const phi = data.steps[data.steps.length - 1].azimuth - 1.1;
    camera.position.set(2.3 * length * Math.cos(phi), 2.3 * length * Math.sin(phi), 1.3 * length);
    const controls = new THREE.OrbitControls(camera, canvas);
    controls.target.set(0, 0, 0.45 * length);
    controls.enablePan = false;
    controls.enableZoom = false; // the wheel belongs to the page
    controls.enableKeys = false;
    const base = new THREE.Mesh(
      new THREE.CircleGeometry(0.6 * length, 48),
      new THREE.MeshLambertMaterial({ color: 0xd5d9df, side: THREE.DoubleSide, transparent: true, opacity: 0.5 }));
    scene.add(base);
    for (const p of data.sensors) {
      const size = 0.35 * data.extents[0];
      const box_of = new THREE.Mesh(new THREE.BoxGeometry(size, size, size / 2), new THREE.MeshLambertMaterial({ color: 0x111111 }));
      box_of.position.set(...p);
      scene.add(box_of);
    }
    let drawn = [];
    function draw() {
      const { clientWidth: width, clientHeight: height } = canvas;
      if (width === 0 || height === 0) return;
      renderer.setPixelRatio(window.devicePixelRatio || 1);
      renderer.setSize(width, height, false);
      camera.aspect = width / height;
      camera.updateProjectionMatrix();
      renderer.render(scene, camera);
    }
    function show(i) {
      for (const object of drawn) {
        scene.remove(object);
        object.geometry.dispose();
        if (object.material.map) object.material.map.dispose();
        object.material.dispose();
      }
      drawn = [];
      const step = data.steps[i];
      let S = 0;
      for (const segment of data.segments) {
        drawn.push(new THREE.Mesh(tube(step, data, S, S + segment.length), new THREE.MeshLambertMaterial({ color: segment.colour, side: THREE.DoubleSide })));
        S += segment.length;
      }
      if (step.plane) drawn.push(plane(step, data.pixels));
      for (const object of drawn) scene.add(object);
      words.textContent = step.load;
      draw();
    }
    slider.addEventListener("input", () => show(Number(slider.value)));
    controls.addEventListener("change", draw);
    canvas.addEventListener("keydown", (event) => {
      const turn = { ArrowLeft: 0.15, ArrowRight: -0.15 }[event.key];
      if (turn === undefined) return;
      event.preventDefault();
      camera.position.applyAxisAngle(new THREE.Vector3(0, 0, 1), turn);
      controls.update();
      draw();
    });
    new ResizeObserver(draw).observe(canvas);
    controls.update();
    show(Number(slider.value));
    box.dataset.ready = "yes";
  }

  // A view starts when it comes into sight: a page may have many, a browser has few contexts.
  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries)
      if (entry.isIntersecting && !entry.target.dataset.ready) start(entry.target);
  });
  document.querySelectorAll(".view").forEach((box) => seen.observe(box));
})();
