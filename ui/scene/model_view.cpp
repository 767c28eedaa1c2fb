#include "ui/scene/model_view.h"

#include <QSurfaceFormat>
#include <QVBoxLayout>
#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkAutoInit.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkInteractionStyle)

namespace tarsus {
namespace {

constexpr double kSkinGrey[3] = {0.80, 0.785, 0.77};

/// Right drag turns like left drag, and VTK's own keys (exit, wireframe, stereo) do nothing.
class TurnStyle : public vtkInteractorStyleTrackballCamera {
 public:
  static TurnStyle* New();
  vtkTypeMacro(TurnStyle, vtkInteractorStyleTrackballCamera)

      void OnRightButtonDown() override {
    OnLeftButtonDown();
  }
  void OnRightButtonUp() override { OnLeftButtonUp(); }
  void OnChar() override {}
  void OnKeyPress() override {}
};
vtkStandardNewMacro(TurnStyle)

    vtkSmartPointer<vtkPolyData> toVtk(const TexturedMesh& model) {
  const TriangleMesh& mesh = model.mesh;
  vtkNew<vtkFloatArray> positions;
  positions->SetNumberOfComponents(3);
  positions->SetNumberOfTuples(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    positions->SetTypedTuple(static_cast<vtkIdType>(i), mesh.vertices[i].data());
  }
  vtkNew<vtkPoints> points;
  points->SetData(positions);

  vtkNew<vtkCellArray> triangles;
  triangles->AllocateExact(static_cast<vtkIdType>(mesh.faces.size()),
                           static_cast<vtkIdType>(3 * mesh.faces.size()));
  for (const Eigen::Vector3i& face : mesh.faces) {
    const vtkIdType corners[3] = {face[0], face[1], face[2]};
    triangles->InsertNextCell(3, corners);
  }

  const std::vector<Eigen::Vector3f> normals =
      mesh.normals.size() == mesh.vertices.size() ? mesh.normals : vertexNormals(mesh);
  vtkNew<vtkFloatArray> directions;
  directions->SetNumberOfComponents(3);
  directions->SetNumberOfTuples(static_cast<vtkIdType>(normals.size()));
  for (std::size_t i = 0; i < normals.size(); ++i) {
    directions->SetTypedTuple(static_cast<vtkIdType>(i), normals[i].data());
  }

  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(points);
  result->SetPolys(triangles);
  result->GetPointData()->SetNormals(directions);
  if (!model.colors.empty()) {
    vtkNew<vtkUnsignedCharArray> colors;
    colors->SetNumberOfComponents(3);
    colors->SetNumberOfTuples(static_cast<vtkIdType>(model.colors.size()));
    for (std::size_t i = 0; i < model.colors.size(); ++i) {
      const unsigned char rgb[3] = {model.colors[i].r, model.colors[i].g, model.colors[i].b};
      colors->SetTypedTuple(static_cast<vtkIdType>(i), rgb);
    }
    result->GetPointData()->SetScalars(colors);
  }
  return result;
}

}  // namespace

struct ModelView::Scene {
  QVTKOpenGLNativeWidget* widget = nullptr;
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;
  vtkNew<vtkCallbackCommand> on_render;
  std::shared_ptr<const TexturedMesh> model;
  bool textured = true;

  void applyTexture() {
    const bool colored = textured && model && !model->colors.empty();
    mapper->SetScalarVisibility(colored ? 1 : 0);
    vtkProperty* property = actor->GetProperty();
    property->SetColor(kSkinGrey[0], kSkinGrey[1], kSkinGrey[2]);
    // The texture already holds the light of the scan; only a little is added to show the shape.
    property->SetAmbient(colored ? 0.55 : 0.15);
    property->SetDiffuse(colored ? 0.50 : 0.90);
    property->SetSpecular(colored ? 0.0 : 0.08);
    property->SetSpecularPower(20.0);
  }
};

ModelView::ModelView(QWidget* parent) : QWidget(parent), scene_(std::make_unique<Scene>()) {
  Scene& scene = *scene_;
  scene.widget = new QVTKOpenGLNativeWidget(this);
  scene.widget->setRenderWindow(scene.window);
  scene.widget->setAccessibleName(tr("Foot model"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(scene.widget);

  const auto dress = [this] {
    const QColor& ground = Look::theme().view;
    scene_->renderer->SetBackground(ground.redF(), ground.greenF(), ground.blueF());
    scene_->widget->update();
  };
  dress();
  connect(&Look::instance(), &Look::changed, this, dress);
  scene.renderer->GetActiveCamera()->ParallelProjectionOn();
  scene.renderer->AddActor(scene.actor);
  scene.actor->SetMapper(scene.mapper);
  scene.actor->SetVisibility(0);
  scene.window->AddRenderer(scene.renderer);
  scene.window->SetMultiSamples(4);
  vtkNew<TurnStyle> style;
  scene.widget->interactor()->SetInteractorStyle(style);

  scene.on_render->SetClientData(this);
  scene.on_render->SetCallback([](vtkObject*, unsigned long, void* view, void*) {
    emit static_cast<ModelView*>(view)->rendered();
  });
  scene.renderer->AddObserver(vtkCommand::EndEvent, scene.on_render);
}

ModelView::~ModelView() { scene_->renderer->RemoveObserver(scene_->on_render); }

void ModelView::showModel(std::shared_ptr<const TexturedMesh> model) {
  Scene& scene = *scene_;
  scene.model = std::move(model);
  scene.mapper->SetInputData(toVtk(*scene.model));
  scene.actor->SetVisibility(1);
  scene.applyTexture();
  look(StandardView::Front);
}

void ModelView::setTextured(bool textured) {
  scene_->textured = textured;
  scene_->applyTexture();
  scene_->window->Render();
}

bool ModelView::textured() const { return scene_->textured; }

void ModelView::look(StandardView view) {
  double from[3] = {0.0, 0.0, 0.0};
  switch (view) {
    case StandardView::Front:
      from[2] = -1.0;
      break;
    case StandardView::Back:
      from[2] = 1.0;
      break;
    case StandardView::Left:
      from[0] = -1.0;
      break;
    case StandardView::Right:
      from[0] = 1.0;
      break;
  }
  vtkCamera* camera = scene_->renderer->GetActiveCamera();
  camera->SetFocalPoint(0.0, 0.0, 0.0);
  camera->SetPosition(from);
  camera->SetViewUp(0.0, -1.0, 0.0);
  fit();
}

void ModelView::fit() {
  scene_->renderer->ResetCamera();
  // VTK fits the enclosing sphere, which leaves a foot small in the picture.
  scene_->renderer->GetActiveCamera()->Zoom(1.25);
  scene_->renderer->ResetCameraClippingRange();
  scene_->window->Render();
}

double ModelView::mmPerPixel() const {
  const int height = std::max(1, scene_->widget->height());
  return 2.0 * scene_->renderer->GetActiveCamera()->GetParallelScale() / height;
}

void prepareGraphics() {
  QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat());
}

}  // namespace tarsus
