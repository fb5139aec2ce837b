"""Programs that draw the same view: Edgesplat and the renderers of VTK."""

from __future__ import annotations

import os
from typing import Callable

import numpy as np

import edgesplat
from views import AMBIENT, DIFFUSE, View

THREADS = os.cpu_count() or 1


class Edgesplat:
    """A renderer of its own, so that it keeps what its frames need."""

    def __init__(self, view: View, **changes) -> None:
        self.view = view
        self.renderer = edgesplat.Renderer()
        self.scene = edgesplat.Scene(view.scene, **changes)

    def draw(self) -> np.ndarray:
        """H x W x 4, linear: colour over the background, opacity."""
        return self.renderer.render(self.view.volume, self.scene, camera=self.view.camera, size=self.view.size).color

    def opacity(self) -> np.ndarray:
        return self.draw()[..., 3]

    def close(self) -> None:
        self.renderer.close()


class Vtk:
    """A window of VTK with one prop. Its world begins at the volume's origin; the prop is turned like the volume."""

    def __init__(self, view: View) -> None:
        import vtk
        from vtk.util.numpy_support import numpy_to_vtk

        self.vtk, self.view = vtk, view
        vtk.vtkSMPTools.Initialize(THREADS)
        samples = view.samples
        self.image = vtk.vtkImageData()
        self.image.SetDimensions(*reversed(samples.shape))
        self.image.SetSpacing(*view.volume.spacing)
        self.flat = numpy_to_vtk(np.ascontiguousarray(samples).ravel())
        self.image.GetPointData().SetScalars(self.flat)
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*view.size)
        self.renderer = vtk.vtkRenderer()
        self.renderer.SetBackground(*view.scene["background"])
        self.renderer.TwoSidedLightingOff()
        self.renderer.AutomaticLightCreationOff()
        # A headlight would be at the eye for one mapper, and at infinity for the others.
        light = vtk.vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPosition(*(-np.asarray(view.camera.direction)))
        light.SetFocalPoint(0, 0, 0)
        light.SetAmbientColor(*self.ambient_color())
        self.renderer.AddLight(light)
        self.window.AddRenderer(self.renderer)
        prop = self.make_prop()
        turned = np.eye(4)
        turned[:3, :3] = np.asarray(view.volume.direction)
        matrix = vtk.vtkMatrix4x4()
        matrix.DeepCopy(turned.ravel())
        prop.SetUserMatrix(matrix)
        self.renderer.AddViewProp(prop)
        self.aim()

    def aim(self) -> None:
        camera, seen = self.renderer.GetActiveCamera(), self.view.camera
        eye, direction = np.asarray(seen.eye) - self.view.volume.origin, np.asarray(seen.direction)
        camera.SetPosition(*eye)
        camera.SetFocalPoint(*(eye + direction / np.linalg.norm(direction)))
        camera.SetViewUp(*seen.up)
        camera.SetViewAngle(seen.fov)
        diagonal = np.linalg.norm(np.asarray(self.view.volume.spacing) * self.image.GetDimensions())
        camera.SetClippingRange(0.05 * min(self.view.volume.spacing), np.linalg.norm(eye) + diagonal)

    def ambient_color(self):
        return 1, 1, 1

    def draw(self) -> np.ndarray:
        """H x W x 3, colour over the background."""
        self.window.Render()
        width, height = self.view.size
        pixels = self.vtk.vtkUnsignedCharArray()
        self.window.GetPixelData(0, 0, width - 1, height - 1, 0, pixels, 0)
        from vtk.util.numpy_support import vtk_to_numpy

        return vtk_to_numpy(pixels).reshape(height, width, 3)[::-1].astype(np.float32) / 255

    def opacity(self) -> np.ndarray:
        """Unlit white matter over black."""
        self.whiten()
        self.renderer.SetBackground(0, 0, 0)
        return self.draw()[..., 0]

    def close(self) -> None:
        self.window.Finalize()

    @staticmethod
    def obstacle() -> str:
        """Why VTK cannot draw here; empty: it can."""
        try:
            import vtk  # noqa: F401
        except ImportError:
            return "VTK is not installed: its package is python3-vtk9"
        if not os.environ.get("DISPLAY"):
            return "no X display for OpenGL: xvfb-run, of the package xvfb, gives one in memory"
        return ""

    @staticmethod
    def about() -> str:
        import vtk

        window = vtk.vtkRenderWindow()
        window.SetOffScreenRendering(1)
        window.Render()
        lines = [x for x in window.ReportCapabilities().splitlines() if "OpenGL renderer string" in x]
        window.Finalize()
        return f"VTK {vtk.vtkVersion.GetVTKVersion()}, OpenGL on {lines[0].split(':', 1)[1].strip()}"


class Polygons(Vtk):
    """Triangles of the surface by vtkFlyingEdges3D, with normals of the samples' gradient."""

    def make_prop(self):
        vtk = self.vtk
        surface = vtk.vtkFlyingEdges3D()
        surface.SetInputData(self.image)
        surface.SetValue(0, self.view.scene["iso_values"][0])
        surface.ComputeNormalsOn()
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(surface.GetOutputPort())
        mapper.ScalarVisibilityOff()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        self.look = actor.GetProperty()
        self.look.SetColor(*self.view.materials[1]["color"])
        self.look.SetAmbient(AMBIENT)
        self.look.SetDiffuse(DIFFUSE)
        self.look.SetInterpolationToPhong()
        return actor

    def whiten(self) -> None:
        self.look.SetColor(1, 1, 1)
        self.look.LightingOff()


class Rays(Vtk):
    """A volume mapper with the suite's materials as steps of its transfer functions, half a voxel a step."""

    def make_mapper(self):
        raise NotImplementedError

    def make_prop(self):
        vtk = self.vtk
        self.mapper = self.make_mapper()
        self.mapper.SetInputData(self.image)
        self.mapper.SetSampleDistance(0.5 * min(self.view.volume.spacing))
        self.mapper.SetAutoAdjustSampleDistances(0)
        self.look = vtk.vtkVolumeProperty()
        self.look.SetInterpolationTypeToLinear()
        self.look.SetScalarOpacityUnitDistance(1)
        self.look.SetShade(self.view.lit)
        self.look.SetAmbient(AMBIENT)
        self.look.SetDiffuse(DIFFUSE)
        self.look.SetSpecular(0)
        self.set_matter([m["color"] for m in self.view.materials])
        volume = vtk.vtkVolume()
        volume.SetMapper(self.mapper)
        volume.SetProperty(self.look)
        return volume

    def set_matter(self, colors) -> None:
        low, high = self.flat.GetRange()
        step = (high - low) / 8192
        opacity, color = self.vtk.vtkPiecewiseFunction(), self.vtk.vtkColorTransferFunction()
        ends = [low, *self.view.scene["iso_values"], high + step]
        for material, tint, begin, end in zip(self.view.materials, colors, ends, ends[1:]):
            amount = 1 - np.exp(-material["extinction"])
            for at in (begin, end - step):
                opacity.AddPoint(at, amount)
                # A colour must not fade into that of matter below, which has none.
                color.AddRGBPoint(at, *(tint if material["extinction"] > 0 else colors[1]))
        self.look.SetScalarOpacity(opacity)
        self.look.SetColor(color)

    def whiten(self) -> None:
        self.set_matter([(1, 1, 1)] * len(self.view.materials))
        self.look.ShadeOff()


class FixedPoint(Rays):
    def make_mapper(self):
        mapper = self.vtk.vtkFixedPointVolumeRayCastMapper()
        mapper.SetNumberOfThreads(THREADS)
        mapper.SetImageSampleDistance(1)
        mapper.SetInteractiveSampleDistance(0.5 * min(self.view.volume.spacing))
        return mapper


class Gpu(Rays):
    def ambient_color(self):
        return self.view.materials[1]["color"]  # this mapper's ambient light does not take the matter's colour

    def make_mapper(self):
        mapper = self.vtk.vtkOpenGLGPUVolumeRayCastMapper()
        mapper.SetUseJittering(0)
        mapper.SetImageSampleDistance(1)
        return mapper


def programs_for(view: View) -> dict[str, Callable[[], Edgesplat | Vtk]]:
    """Makers of the programs that can draw the view, by name; the first is what others are compared with."""
    makers = {
        "Edgesplat": lambda: Edgesplat(view),
        "Edgesplat, plain": lambda: Edgesplat(view, quality={"edges": "off"}),
        "Edgesplat, ray caster": lambda: Edgesplat(view, output={"renderer": "raycast"}),
    }
    if not Vtk.obstacle():
        makers["VTK fixed-point rays"] = lambda: FixedPoint(view)
        makers["VTK GPU rays"] = lambda: Gpu(view)
        if view.lit:
            makers["VTK polygons"] = lambda: Polygons(view)
    return makers
